// Error against run time: one chart per scene, all methods, and the factors between them.

const ERROR_METRICS = {
  nmse: { label: "NMSE", unit: "", title: "normalised mean squared error, Σ(x − r)²/Σr²" },
  rmse: { label: "RMSE", unit: "W m⁻² sr⁻¹", title: "root mean squared error of a cell" },
  variance: { label: "variance", unit: "", title: "the part of the NMSE that is variance" },
  squared_bias: { label: "bias²", unit: "", title: "the part of the NMSE that is squared bias; where noise makes its estimate negative there is no point" },
  inverse_efficiency: { label: "variance × CPU time", unit: "s", title: "constant where variance falls as 1/time" },
};

const CLOCKS = { cpu: "CPU time of all threads", wall: "wall time" };

/** The scene that is shown, with its drawable curves: {scene, curves: [{curve, index, points, shown}]}. */
function shownScene(data) {
  const all = data.error_time.scenes;
  const scene = all.find((candidate) => candidate.scene === state.scene) ?? all[0];
  const hidden = state.hidden.split(" ");
  return { scene, curves: curvesOf(scene, (method) => !hidden.includes(method)) };
}

function curvesOf(scene, isShown) {
  return scene.curves.map((curve, index) => ({
    curve, index, points: curvePoints(curve, state.clock, state.metric), shown: isShown(curve.method),
  }));
}

const curveColour = (index) => `--method-${index % 9}`;
const estimateText = (e) => (e.value === null ? "–" : `${digits(e.value)} [${digits(e.interval[0])}, ${digits(e.interval[1])}]`);
const slopeText = (slope) => (slope ? `${slope.value.toFixed(2)} [${slope.interval.map((end) => (end === null ? "∞" : end.toFixed(2))).join(", ")}]`.replace(/-/g, "−") : "not resolved");

/** Ends of what is drawn: {x: [low, high], y: [low, high]}, or null without points. */
function errorRange(curves) {
  const points = curves.filter((c) => c.shown).flatMap((c) => c.points);
  if (points.length === 0) return null;
  const values = points.map((p) => p.value);
  const floor = Math.min(...values) / 4;
  const lows = points.map((p) => Math.max(floor, p.low));
  const highs = points.map((p) => (p.high === Infinity ? p.value : p.high));
  const times = points.map((p) => p.t);
  return {
    x: [Math.min(...times) / 1.25, Math.max(...times) * 1.25],
    y: [Math.min(...lows) / 1.3, Math.max(...highs) * 1.3],
  };
}

/** Columns for uPlot: the times of all curves, then low, high, value of each. */
function errorColumns(curves, floor) {
  const tables = curves.map(({ points, shown }) => {
    const kept = shown ? points : [];
    return [
      kept.map((p) => p.t), kept.map((p) => Math.max(floor, p.low)), kept.map((p) => (p.high === Infinity ? p.value : p.high)), kept.map((p) => p.value),
    ];
  });
  return uPlot.join(tables);
}

/** The comparison's time and error: those chosen, or where the curves still meet. */
function comparedAt(curves, chosen = state) {
  const shown = curves.filter((c) => c.shown && c.points.length > 0);
  const base = baseOf(curves);
  const ends = shown.map((c) => c.points.at(-1).t);
  const starts = shown.map((c) => c.points[0].t);
  const times = [Math.max(...starts), Math.min(...ends)];
  const values = shown.flatMap((c) => c.points.map((p) => p.value));
  const errors = [Math.min(...values), Math.max(...values)];
  const within = (value, [low, high]) => Math.min(high, Math.max(low, value));
  return {
    times, errors,
    time: within(chosen.atTime ?? times[1], times),
    error: within(chosen.atError ?? base?.points.at(-1)?.value ?? errors[0], errors),
  };
}

function baseOf(curves) {
  return curves.find((c) => c.curve.method === state.base) ?? curves.find((c) => c.curve.method === "path") ?? curves[0];
}

function drawErrorChart(data) {
  const { scene, curves } = shownScene(data);
  const box = byId("error-chart");
  const metric = ERROR_METRICS[state.metric];
  byId("error-note").textContent = `${metric.label}: ${metric.title}. Bands: 95 % intervals over ${scene.replicates} runs, the reference's noise included; both axes are logarithmic.`;
  keepPlot(box, () => {
    const range = errorRange(curves);
    if (!range) return null;
    const compared = comparedAt(curves);
    const style = axisStyle();
    const series = [{}];
    const bands = [];
    for (const { curve, index } of curves) {
      const colour = cssValue(curveColour(index));
      const edge = { stroke: "transparent", width: 0, points: { show: false }, spanGaps: true };
      series.push(edge, edge, { label: curve.method, stroke: colour, width: 2, spanGaps: true, points: { show: true, size: 6, fill: colour } });
      bands.push({ series: [3 * index + 2, 3 * index + 1], fill: `color-mix(in srgb, ${colour} 18%, transparent)` });
    }
    const ticks = { splits: (u, i, low, high) => logTicks(low, high), values: (u, at) => at.map((t) => (t === null ? "" : digits(t, 1))), filter: (u, at) => at };
    const unit = metric.unit ? `${metric.label} [${metric.unit}]` : metric.label;
    const u = new uPlot({
      width: box.clientWidth, height: box.clientHeight, legend: { show: false }, series, bands,
      scales: { x: { time: false, distr: 3, range: () => range.x }, y: { distr: 3, range: () => range.y } },
      axes: [
        { ...style, ...ticks, size: 34, label: `${CLOCKS[state.clock]} [s]`, labelSize: 18 },
        { ...style, ...ticks, size: 58, label: unit, labelSize: 18 },
      ],
      cursor: { drag: { x: false, y: false }, points: { show: false } },
      hooks: {
        setCursor: [(plot) => pointAtCursor(curves, plot)],
        draw: [(plot) => drawMarks(plot, curves, compared, scene, range)],
      },
    }, errorColumns(curves, range.y[0]), box);
    u.over.addEventListener("click", () => update({ atTime: u.posToVal(u.cursor.left, "x") }));
    return u;
  });
  describeErrors(scene, curves);
}

/** Error bars, the time and error at which methods are compared, the reference's own error. */
function drawMarks(u, curves, compared, scene, range) {
  const { ctx, bbox } = u;
  for (const { points, shown, index } of curves) {
    if (!shown) continue;
    const lows = points.map((p) => Math.max(range.y[0], p.low));
    const highs = points.map((p) => (p.high === Infinity ? range.y[1] : p.high));
    drawBars(u, points.map((p) => p.t), lows, highs, cssValue(curveColour(index)));
  }
  const line = (from, to, colour, dash) => {
    ctx.strokeStyle = cssValue(colour);
    ctx.setLineDash(dash.map((d) => d * devicePixelRatio));
    ctx.beginPath();
    ctx.moveTo(...from);
    ctx.lineTo(...to);
    ctx.stroke();
  };
  ctx.save();
  ctx.lineWidth = devicePixelRatio;
  const x = u.valToPos(compared.time, "x", true);
  line([x, bbox.top], [x, bbox.top + bbox.height], "--time", []);
  const across = (value, colour, dash) => {
    if (!(value > range.y[0] && value < range.y[1])) return;
    const y = u.valToPos(value, "y", true);
    line([bbox.left, y], [bbox.left + bbox.width, y], colour, dash);
  };
  across(compared.error, "--time", []);
  if (state.metric === "nmse") across(scene.reference_nmse, "--muted", [2, 4]);
  ctx.restore();
}

/** What the tip says of a point. */
function pointText({ curve }, point) {
  const c = point.checkpoint;
  return `${curve.method}, ${c.passes} ${c.passes === 1 ? "pass" : "passes"}\n${ERROR_METRICS[state.metric].label} ${estimateText(c[state.metric])}\nCPU ${digits(c.cpu_seconds)} s, wall ${digits(c.wall_seconds)} s`;
}

/** Shows the point nearest to the cursor. */
function pointAtCursor(curves, u) {
  const { left, top } = u.cursor;
  if (left === null || left < 0) return hideTip(byId("error-chart"));
  const all = curves.filter((c) => c.shown).flatMap((c) => c.points.map((point) => ({
    of: c, point, distance: Math.hypot(u.valToPos(point.t, "x") - left, u.valToPos(point.value, "y") - top),
  })));
  const nearest = all.reduce((best, one) => (one.distance < best.distance ? one : best), { distance: 60 });
  if (nearest.of) showPoint(u, nearest.of, nearest.point);
  else hideTip(byId("error-chart"));
  return undefined;
}

function showPoint(u, of, point) {
  const box = byId("error-chart");
  const text = pointText(of, point);
  showTip(box, u.over.offsetLeft + u.valToPos(point.t, "x"), u.over.offsetTop + u.valToPos(point.value, "y"), text);
  return text;
}

/** Arrow keys: along a curve, and to another one. */
function stepPoint(data, along, across) {
  const { curves } = shownScene(data);
  const shown = curves.filter((c) => c.shown && c.points.length > 0);
  const plot = plots.get(byId("error-chart"))?.plot;
  if (shown.length === 0 || !plot) return;
  const last = state.point ?? { curve: 0, at: -1 };
  const curve = (last.curve + across + shown.length) % shown.length;
  const at = Math.min(shown[curve].points.length - 1, Math.max(0, last.at + along));
  update({ point: { curve, at } });
  byId("live").textContent = showPoint(plot, shown[curve], shown[curve].points[at]);
}

function describeErrors(scene, curves) {
  const ends = curves.filter((c) => c.shown && c.points.length > 0).map((c) => {
    const { t, value } = c.points.at(-1);
    return `${c.curve.method}: ${digits(value)} after ${digits(t)} s`;
  });
  byId("error-chart").setAttribute("aria-label", `${ERROR_METRICS[state.metric].label} of ${scene.scene} against ${CLOCKS[state.clock]}, logarithmic axes. ${ends.join("; ")}.`);
}

/** Buttons of scenes and methods. */
function drawErrorControls(data) {
  const { scene, curves } = shownScene(data);
  const button = (text, pressed, mark, act) => {
    const node = element("button", { type: "button", "aria-pressed": String(pressed) }, [...mark, document.createTextNode(text)]);
    node.addEventListener("click", act);
    return node;
  };
  byId("scenes").replaceChildren(...data.error_time.scenes.map((one) => button(one.scene, one === scene, [], () => showScene(one.scene))));
  byId("methods").replaceChildren(...curves.map(({ curve, index, shown }) => {
    const mark = element("span", { className: `swatch method-${index % 9}`, "aria-hidden": "true" });
    return button(curve.method, shown, [mark], () => toggleMethod(curve.method));
  }));
  const base = byId("base");
  base.replaceChildren(...curves.map(({ curve }) => element("option", { value: curve.method, text: curve.method })));
  base.value = baseOf(curves).curve.method;
  byId("metric").value = state.metric;
  byId("clock").value = state.clock;
}

const showScene = (scene) => update({ scene, atTime: null, atError: null, point: null, hidden: "" });

function toggleMethod(method) {
  const hidden = state.hidden.split(" ").filter(Boolean);
  const next = hidden.includes(method) ? hidden.filter((h) => h !== method) : [...hidden, method];
  update({ hidden: next.join(" "), point: null });
}

/** Where a value lies between two ends on a logarithmic slider of 1000 steps, and back. */
const toSlider = (value, [low, high]) => Math.round((1000 * Math.log(value / low)) / (Math.log(high / low) || 1));
const fromSlider = (at, [low, high]) => low * (high / low) ** (at / 1000);

function drawFactors(data) {
  const { curves } = shownScene(data);
  const compared = comparedAt(curves);
  const base = baseOf(curves);
  const sliders = [["at-time", compared.time, compared.times, `${digits(compared.time)} s`], ["at-error", compared.error, compared.errors, digits(compared.error)]];
  for (const [id, value, ends, text] of sliders) {
    byId(id).value = String(toSlider(value, ends));
    byId(id).setAttribute("aria-valuetext", text);
    byId(`${id}-text`).textContent = text;
  }
  const rows = curves.filter((c) => c.shown).map((c) => element("tr", { className: c === base ? "current" : "" }, [
    element("th", { scope: "row" }, [element("span", { className: `swatch method-${c.index % 9}`, "aria-hidden": "true" }), document.createTextNode(c.curve.method)]),
    cell(c === base ? "1" : factorText(factorAtTime(base.points, c.points, compared.time)), "number"),
    cell(c === base ? "1" : factorText(factorAtError(base.points, c.points, compared.error)), "number"),
    cell(slopeText(c.curve.slope), "number"),
  ]));
  byId("factors").replaceChildren(
    tableHead([["method"], ["less error at that time", true], ["faster to that error", true], ["slope", true, "d ln NMSE/d ln CPU seconds"]]),
    element("tbody", {}, rows),
  );
  byId("factors-note").textContent = `Over 1: better than ${base.curve.method}. [95 % intervals], both curves taken as independent; straight lines between checkpoints, nothing extrapolated (≥, ≤: a curve ends before). Slope: of NMSE against CPU time; −1 for independent samples without bias.`;
}

/** All scenes and methods at equal time: the longest that all methods of a scene have. */
function drawAllScenes(data) {
  const rows = data.error_time.scenes.flatMap((scene) => {
    const curves = curvesOf(scene, () => true);
    const compared = comparedAt(curves, {});
    const base = baseOf(curves);
    return curves.map((c, index) => {
      const at = valueAt(c.points, compared.time);
      const ends = at ? [at.value * Math.exp(-at.down), at.value * Math.exp(at.up)] : null;
      return element("tr", {}, [
        element("th", { scope: "row", text: index === 0 ? scene.scene : "" }),
        element("td", {}, [element("span", { className: `swatch method-${c.index % 9}`, "aria-hidden": "true" }), document.createTextNode(c.curve.method)]),
        cell(`${digits(compared.time)} s`, "number"),
        cell(at ? `${digits(at.value)} [${digits(ends[0])}, ${digits(ends[1])}]` : "–", "number"),
        cell(c === base ? "1" : factorText(factorAtTime(base.points, c.points, compared.time)), "number"),
        cell(c === base ? "1" : factorText(factorAtError(base.points, c.points, compared.error)), "number"),
      ]);
    });
  });
  byId("all-scenes").replaceChildren(
    tableHead([["scene"], ["method"], [CLOCKS[state.clock], true], [`${ERROR_METRICS[state.metric].label} then`, true], ["less error at that time", true], ["faster to the base's last error", true]]),
    element("tbody", {}, rows),
  );
}

/** All checkpoints in numbers. */
function drawPoints(data) {
  const { scene, curves } = shownScene(data);
  const row = (of, c) => element("tr", {}, [
    element("th", { scope: "row" }, [element("span", { className: `swatch method-${of.index % 9}`, "aria-hidden": "true" }), document.createTextNode(of.curve.method)]),
    cell(String(c.passes), "number"), cell(digits(c.wall_seconds), "number"), cell(digits(c.cpu_seconds), "number"),
    ...Object.keys(ERROR_METRICS).map((metric) => cell(estimateText(c[metric]), "number")),
  ]);
  byId("points").replaceChildren(
    tableHead([["method"], ["passes", true], ["wall s", true], ["CPU s", true], ...Object.values(ERROR_METRICS).map((m) => [m.label, true, m.title])]),
    element("tbody", {}, curves.filter((c) => c.shown).flatMap((of) => of.curve.checkpoints.map((c) => row(of, c)))),
  );
  const about = scene.circumstances ?? {};
  byId("measured").replaceChildren(...terms([
    ["scene", scene.scene],
    ["runs", `${scene.replicates} of each method, seeds from ${scene.seed}, ${scene.threads} threads`],
    ["commit", about.commit], ["machine", about.machine], ["flags", about.flags],
    ["reference", `commit ${scene.reference.commit || "unknown"}, ${digits(scene.reference.cpu_seconds)} CPU s, own NMSE ${digits(scene.reference_nmse)}`],
    ...(scene.left_out ?? []).map((reason) => ["left out", reason]),
    ["pixels judged", `${scene.pixels[0]} of ${scene.pixels[1]}`],
    ...curves.map(({ curve }) => [curve.method, `preparation ${digits(curve.setup_seconds)} s, slope of its variance ${slopeText(curve.variance_slope)}, options ${JSON.stringify(curve.options)}`]),
  ]));
  byId("measured-command").replaceChildren(commandBox(`cargo xtask error-time --scene ${scene.scene}`));
}

function buildErrors(data) {
  const { scenes, unread } = data.error_time;
  const missing = [];
  if (scenes.length === 0) missing.push(missingCard("No errors against run time were measured yet.", COMMANDS.errors));
  if (unread.length > 0) missing.push(element("p", { className: "card note", text: `Not shown: ${unread.join("; ")}` }));
  byId("errors-missing").replaceChildren(...missing);
  byId("errors-found").hidden = scenes.length === 0;
  if (scenes.length === 0) return;
  const fill = (id, entries) => {
    byId(id).replaceChildren(...entries.map(([value, text]) => element("option", { value, text })));
  };
  fill("metric", Object.entries(ERROR_METRICS).map(([name, { label }]) => [name, label]));
  fill("clock", Object.entries(CLOCKS));
  byId("metric").addEventListener("change", (event) => update({ metric: event.target.value, atError: null }));
  byId("clock").addEventListener("change", (event) => update({ clock: event.target.value, atTime: null }));
  byId("base").addEventListener("change", (event) => update({ base: event.target.value, atError: null }));
  const slide = (id, ends, key) => byId(id).addEventListener("input", (event) => {
    update({ [key]: fromSlider(Number(event.target.value), comparedAt(shownScene(data).curves)[ends]) });
  });
  slide("at-time", "times", "atTime");
  slide("at-error", "errors", "atError");
}

function drawErrors(data) {
  if (state.tab !== "errors" || data.error_time.scenes.length === 0) return;
  drawErrorControls(data);
  drawErrorChart(data);
  drawFactors(data);
  drawPoints(data);
  drawAllScenes(data);
}
