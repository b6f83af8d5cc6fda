// Curves over time, by uPlot: the selected pixel's response, and errors frame by frame.

const CHART_KINDS = {
  pixel: { label: "Response", log: true },
  mean: { label: "Mean of image", log: true },
  nmse: { label: "NMSE of frames", log: true, judges: true },
  bias: { label: "Bias of frames", log: false, judges: true },
};

/** Decades that a logarithmic axis shows at most. */
const AXIS_DECADES = 6;

const chart = { plot: null, config: "", range: [0, 1], edges: [] };

const methodColour = (v, index) =>
  cssValue(v.cubes[index].entry.reference ? "--ink" : `--method-${index % 9}`);

/** Whether the vertical axis is logarithmic. */
const isLog = () => state.logAxis && CHART_KINDS[state.chartKind].log;

/** Values, and half widths of their intervals, of one method. */
function curveOf(v, cube) {
  if (state.chartKind !== "pixel") {
    return { values: cube.entry.frames[state.chartKind], halves: null };
  }
  const pixel = state.y * v.width + state.x;
  const values = [];
  const halves = cube.hasErrors ? [] : null;
  for (let bin = 0; bin < v.bins; bin++) {
    values.push(cube.reading(bin, pixel, state.channel));
    halves?.push(cube.interval * cube.readingError(bin, pixel, state.channel));
  }
  return { values, halves };
}

/** Part of the window that a zoomed chart shows, around the slider's time. */
const ZOOMED = 0.2;

/** The horizontal range: the window, or what is near the slider's time. */
function timeRange(v) {
  const ends = [chart.edges[0], chart.edges[chart.edges.length - 1]];
  if (!state.chartZoom) return ends.map((edge) => v.time.of(edge));
  const half = (ZOOMED / 2) * (ends[1] - ends[0]);
  const middle = Math.min(ends[1] - half, Math.max(ends[0] + half, 0.5 * (v.edges[state.bin] + v.edges[state.bin + 1])));
  return [middle - half, middle + half].map((edge) => v.time.of(edge));
}

/** A range of the vertical axis around the curves (bands may leave it). */
function rangeOf(curves) {
  let low = Infinity;
  let high = -Infinity;
  for (const { values } of curves) for (const value of values) {
    if (value === null || !Number.isFinite(value) || (isLog() && value <= 0)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (high === -Infinity) return isLog() ? [1e-6, 1] : [0, 1];
  if (isLog()) return [Math.max(low / 1.5, high * 10 ** -AXIS_DECADES), high * 2];
  const [bottom, top] = [Math.min(0, low), Math.max(0, high)];
  const margin = 0.06 * (top - bottom || 1);
  return [bottom < 0 ? bottom - margin : 0, top + margin];
}

/** Columns for uPlot: lower edges (and the last upper one), then low, high, value of each method. */
function chartData(v) {
  const edges = state.chartKind === "pixel" ? v.edges : v.manifest.curve_edges ?? v.edges;
  chart.edges = edges;
  const curves = v.cubes.map((cube) => curveOf(v, cube));
  chart.range = rangeOf(curves);
  const floor = chart.range[0] * 1e-3;
  const shown = (value) => (value === null || !Number.isFinite(value) || (isLog() && value <= 0) ? null : value);
  const stepped = (values) => [...values, values[values.length - 1] ?? null];
  const columns = [Array.from(edges, (edge) => v.time.of(edge))];
  for (const { values, halves } of curves) {
    const bound = (sign) => values.map((value, bin) => {
      if (!halves || !Number.isFinite(halves[bin]) || shown(value) === null) return null;
      const end = value + sign * halves[bin];
      return isLog() ? Math.max(end, floor) : end;
    });
    columns.push(stepped(bound(-1)), stepped(bound(1)), stepped(Array.from(values, shown)));
  }
  return columns;
}

function chartOptions(v, box) {
  const paths = uPlot.paths.stepped({ align: 1 });
  const none = { show: false };
  const series = [{}];
  const bands = [];
  v.cubes.forEach((cube, index) => {
    const colour = methodColour(v, index);
    const width = index === state.method ? 2.25 : 1.25;
    const edge = { paths, points: none, stroke: "transparent", width: 0 };
    series.push(edge, edge, {
      label: cube.entry.label, paths, points: none, stroke: colour, width,
      dash: cube.entry.reference ? [5, 4] : undefined,
    });
    bands.push({ series: [3 * index + 2, 3 * index + 1], fill: `color-mix(in srgb, ${colour} 18%, transparent)` });
  });
  const axis = axisStyle();
  return {
    width: box.clientWidth, height: box.clientHeight, legend: none,
    series, bands,
    scales: {
      x: { time: false, range: () => timeRange(v) },
      y: { distr: isLog() ? 3 : 1, range: () => chart.range },
    },
    axes: [
      { ...axis, size: 34, label: v.manifest.timed ? `time [${v.time.name}]` : "bin", labelSize: 16 },
      {
        ...axis, size: 58, splits: (u, index, low, high) => (isLog() ? decades(low, high) : evenTicks(low, high)),
        values: (u, ticks) => ticks.map((t) => (t === null ? "" : digits(t, isLog() ? 1 : 2))),
      },
    ],
    cursor: { drag: { x: false, y: false }, y: false, points: none },
    hooks: { draw: [(u) => drawTimeLine(v, u)] },
  };
}

/** The time of the slider. */
function drawTimeLine(v, u) {
  const centre = v.time.of(0.5 * (v.edges[state.bin] + v.edges[state.bin + 1]));
  const x = Math.round(u.valToPos(centre, "x", true));
  u.ctx.save();
  u.ctx.strokeStyle = cssValue("--time");
  u.ctx.lineWidth = 1.5 * devicePixelRatio;
  u.ctx.setLineDash([]);
  u.ctx.beginPath();
  u.ctx.moveTo(x, u.bbox.top);
  u.ctx.lineTo(x, u.bbox.top + u.bbox.height);
  u.ctx.stroke();
  u.ctx.restore();
}

/** The bin at a horizontal place of the plot. */
function binAtPlace(v, u, left) {
  const time = u.posToVal(left, "x");
  const after = v.edges.findIndex((edge) => v.time.of(edge) > time);
  return after < 0 ? v.bins - 1 : Math.max(0, after - 1);
}

/** Click or drag sets the time. */
function listenToChart(v, u) {
  const move = (event) => {
    if (event.buttons !== 1) return;
    const box = u.over.getBoundingClientRect();
    goTo(v, binAtPlace(v, u, event.clientX - box.left));
  };
  u.over.addEventListener("pointerdown", move);
  u.over.addEventListener("pointermove", move);
}

function drawChart(v) {
  if (v.bins === 0) return;
  const box = byId("chart");
  const dark = cssValue("--ink");
  const config = [state.chartKind, isLog(), state.method, dark, box.clientWidth, box.clientHeight].join();
  const data = chartData(v);
  if (config !== chart.config || !chart.plot) {
    chart.plot?.destroy();
    chart.plot = new uPlot(chartOptions(v, box), data, box);
    chart.config = config;
    listenToChart(v, chart.plot);
  } else {
    chart.plot.setData(data);
  }
  describeChart(v, data);
}

/** Moves the line of the slider's time alone. */
function redrawTimeLine() {
  chart.plot?.redraw(false, state.chartZoom);
}

/** How wide the bands are, and from how many batches their standard errors: said once for methods that are alike. */
function bandsOf(v) {
  const widths = new Map();
  for (const { entry, interval } of v.cubes.filter((cube) => cube.hasErrors)) {
    const from = entry.batches === null ? "of an unknown number of batches, taken as many" : `of ${entry.batches} batches`;
    const width = Number.isNaN(interval) ? `none, from ${entry.batches} batch` : `±${digits(interval)} standard errors ${from}`;
    widths.set(width, [...(widths.get(width) ?? []), entry.label]);
  }
  const all = widths.size === 1 && v.cubes.every((cube) => cube.hasErrors);
  return [...widths].map(([width, labels]) => (all ? width : `${labels.join(", ")} ${width}`)).join("; ");
}

function describeChart(v, data) {
  const kind = state.chartKind;
  byId("chart-title").textContent = kind === "pixel" ? `Pixel ${v.column(state.x)}, ${v.row(state.y)}` : "All pixels";
  const peaks = v.cubes.map((cube, index) => {
    const values = data[3 * index + 3];
    let at = -1;
    values.forEach((value, bin) => {
      if (value !== null && (at < 0 || value > values[at])) at = bin;
    });
    return at < 0 ? `${cube.entry.label}: nothing` : `${cube.entry.label}: largest ${digits(values[at])} at ${v.timeBetween(chart.edges, at)}`;
  });
  const what = kind === "pixel" ? `Time response of column ${v.column(state.x)}, row ${v.row(state.y)}` : `${CHART_KINDS[kind].label} against time`;
  byId("chart").setAttribute("aria-label", `${what}, ${isLog() ? "logarithmic" : "linear"} axis. ${peaks.join("; ")}.`);
  const notes = [];
  if (kind === "pixel") notes.push(v.unit);
  if (kind === "pixel" && v.cubes.some((cube) => cube.hasErrors)) {
    const reduced = v.manifest.factors.some((factor) => factor > 1) || (state.channel === "luminance" && v.channels === 3);
    notes.push(`bands: 95 % by Student's t: ${bandsOf(v)}${reduced ? " (an upper bound: bins, pixels or channels that were added may err together)" : ""}`);
  }
  else if (kind === "pixel") notes.push("no bands: these results carry no variance (tpb render --variance keeps it)");
  const group = v.manifest.curve_bins;
  if (kind !== "pixel") notes.push(`over all pixels and channels, at full size${group > 1 ? `, ${group} bins together` : ""}`);
  if (kind === "mean") notes.push(v.unit);
  byId("chart-note").textContent = notes.join(" · ");
}
