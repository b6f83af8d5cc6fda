// Factors between two curves, on logarithmic axes: straight lines between checkpoints.
//
// At equal time T the factor is error_base(T)/error(T); at equal error E it is time_base(E)/time(E),
// with time(E) the time from which on the curve stays below E. Both are over 1 where the method is
// better. Nothing is extrapolated: beyond a curve's ends there is no value, or a bound. The interval
// of an error is interpolated like the error; that of a time is where the ends of the interval
// cross E. Both curves are taken as independent: ends are combined in quadrature of logarithms,
//
// > ln f − √(down_b² + up_m²)  …  ln f + √(up_b² + down_m²).

/** Points of a curve that can be drawn: {t, value, low, high, checkpoint}. */
function curvePoints(curve, clock, metric) {
  return curve.checkpoints.map((checkpoint) => {
    const { value, interval } = checkpoint[metric];
    return { t: checkpoint[`${clock}_seconds`], value, low: interval[0] ?? 0, high: interval[1] ?? Infinity, checkpoint };
  }).filter((point) => point.value !== null && point.value > 0 && point.t > 0);
}

const mix = (a, b, part) => a + part * (b - a);

/** Value at a time, with the logarithmic widths of its interval; null beyond the ends. */
function valueAt(points, time) {
  const next = points.findIndex((point) => point.t >= time);
  if (next < 0 || (next === 0 && points[0].t > time)) return null;
  const [a, b] = [points[Math.max(0, next - 1)], points[next]];
  const part = a.t === b.t ? 0 : Math.log(time / a.t) / Math.log(b.t / a.t);
  const value = Math.exp(mix(Math.log(a.value), Math.log(b.value), part));
  const width = (of) => (part === 0 ? of(a) : part === 1 ? of(b) : mix(of(a), of(b), part));
  const down = (point) => (point.low > 0 ? Math.log(point.value / point.low) : Infinity);
  return { value, down: width(down), up: width((point) => Math.log(point.high / point.value)) };
}

/** The time from which `of(point)` stays below an error: {time} or {before} or {after} an end. */
function crossing(points, error, of) {
  if (points.length === 0) return {};
  let first = points.length;
  while (first > 0 && of(points[first - 1]) <= error) first--;
  if (first === points.length) return { after: points.at(-1).t };
  if (first === 0) return { before: points[0].t };
  const [a, b] = [points[first - 1], points[first]];
  if (!(of(b) > 0) || of(a) === Infinity) return { time: b.t };
  const part = Math.log(error / of(a)) / Math.log(of(b) / of(a));
  return { time: Math.exp(mix(Math.log(a.t), Math.log(b.t), part)) };
}

function combine(factor, base, method) {
  const half = (a, b) => Math.hypot(a, b);
  return { factor, interval: [factor * Math.exp(-half(base.down, method.up)), factor * Math.exp(half(base.up, method.down))] };
}

/** {factor, interval}, or null where a curve has no value. */
function factorAtTime(base, method, time) {
  const [b, m] = [valueAt(base, time), valueAt(method, time)];
  return b && m ? combine(b.value / m.value, b, m) : null;
}

/** Logarithmic widths of the interval of the time at which an error is reached. */
function timeWidths(points, error, time) {
  const [early, late] = [crossing(points, error, (p) => p.low), crossing(points, error, (p) => p.high)];
  return {
    down: early.time ? Math.max(0, Math.log(time / early.time)) : Infinity,
    up: late.time ? Math.max(0, Math.log(late.time / time)) : Infinity,
  };
}

/** {factor, interval} or a bound {least} or {most}, or null where nothing can be said. */
function factorAtError(base, method, error) {
  const value = (point) => point.value;
  const [b, m] = [crossing(base, error, value), crossing(method, error, value)];
  if (b.time && m.time) {
    return combine(b.time / m.time, timeWidths(base, error, b.time), timeWidths(method, error, m.time));
  }
  const [slowBase, fastMethod] = [b.time ?? b.after, m.time ?? m.before];
  if (slowBase && fastMethod) return { least: slowBase / fastMethod };
  const [fastBase, slowMethod] = [b.time ?? b.before, m.time ?? m.after];
  if (fastBase && slowMethod) return { most: fastBase / slowMethod };
  return null;
}

/** A factor as people read it. */
function factorText(factor) {
  if (!factor) return "–";
  if (factor.least !== undefined) return `≥ ${digits(factor.least)}`;
  if (factor.most !== undefined) return `≤ ${digits(factor.most)}`;
  return `${digits(factor.factor)} [${digits(factor.interval[0])}, ${digits(factor.interval[1])}]`;
}
