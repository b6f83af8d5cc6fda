// Numbers, times and units as people read them.

const SPEED_OF_LIGHT = 299792458;

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

/** How times are shown: a unit that suits the window, or numbers of bins. */
class TimeUnit {
  constructor(manifest) {
    const edges = manifest.edges;
    this.timed = manifest.timed;
    const last = edges.length ? Math.max(Math.abs(edges[0]), Math.abs(edges[edges.length - 1])) : 0;
    const seconds = last / SPEED_OF_LIGHT;
    const units = [["s", 1], ["ms", 1e-3], ["µs", 1e-6], ["ns", 1e-9], ["ps", 1e-12], ["fs", 1e-15]];
    const fits = units.find(([, size]) => seconds >= size) ?? units[units.length - 1];
    [this.name, this.size] = this.timed ? fits : ["bins", 1];
    // Enough decimals to tell neighbouring bins apart.
    const width = edges.length > 1 ? this.of((edges[edges.length - 1] - edges[0]) / (edges.length - 1)) : 1;
    this.decimals = this.timed ? Math.min(9, Math.max(0, 1 - Math.floor(Math.log10(Math.abs(width))))) : 0;
  }

  /** OPL in metres (or a number of bins) in this unit. */
  of(opl) {
    return this.timed ? opl / SPEED_OF_LIGHT / this.size : opl;
  }

  text(opl) {
    return Number.isFinite(opl) ? `${this.of(opl).toFixed(this.decimals)} ${this.name}` : "–";
  }
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
