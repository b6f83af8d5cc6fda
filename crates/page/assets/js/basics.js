// Numbers as people read them, and elements.

/** Three (or more) digits; small and large numbers with a power of ten. */
function digits(value, count = 3) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size === Infinity) return value > 0 ? "∞" : "−∞";
  const text = size >= 1e-3 && size < 1e5 ? plain(size, count) : size.toExponential(count - 1).replace("e+", "e");
  return (value < 0 ? "−" : "") + text.replace("e-", "e−");
}

/** `count` digits without an exponent. */
function plain(size, count) {
  const before = Math.floor(Math.log10(size)) + 1;
  return size.toFixed(Math.max(0, Math.min(12, count - before)));
}

function percent(value, count = 3) {
  return value === null || value === undefined ? "–" : `${digits(100 * value, count)} %`;
}

/** An element with a class, text and attributes. */
function element(tag, { text, className, ...attributes } = {}, children = []) {
  const node = document.createElement(tag);
  if (text !== undefined) node.textContent = text;
  if (className) node.className = className;
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

const byId = (id) => document.getElementById(id);
