// Axes of charts.

/** A colour of the theme. */
const cssValue = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** What all axes of a chart have in common. */
function axisStyle() {
  const grid = { stroke: cssValue("--line"), width: 1 };
  const font = "12px system-ui, sans-serif";
  return { stroke: cssValue("--muted"), grid, ticks: grid, font, labelFont: font };
}

/** Powers of ten between two values. */
function decades(low, high) {
  const all = [];
  for (let power = Math.ceil(Math.log10(low)); power <= Math.log10(high); power++) all.push(10 ** power);
  return all;
}

/** Ticks of a logarithmic axis: powers of ten, and 2 and 5 times them where there are few. */
function logTicks(low, high) {
  const powers = decades(low, high);
  if (powers.length > 3) return powers;
  const all = decades(low / 10, high).flatMap((power) => [power, 2 * power, 5 * power]);
  return all.filter((tick) => tick >= low && tick <= high);
}

/** Up to seven even ticks at 1, 2 or 5 times a power of ten, however small the values are. */
function evenTicks(low, high) {
  const rough = (high - low) / 7;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= 0.999 * rough);
  const all = [];
  for (let at = Math.ceil(low / step); at <= high / step; at++) all.push(at * step);
  return all;
}
