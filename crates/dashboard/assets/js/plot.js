// What all charts share: the tip beside the cursor, error bars, redrawing, trends over commits.

/** Charts that are drawn, by the element that holds them: {draw, plot}. */
const plots = new Map();

/** Draws a chart now, and again whenever the theme or the size changes. `make(box)` returns it. */
function keepPlot(box, make) {
  plots.get(box)?.plot?.destroy();
  const entry = { plot: null, draw: () => {
    entry.plot?.destroy();
    entry.plot = null;
    if (box.clientWidth > 0) entry.plot = make(box);
  } };
  plots.set(box, entry);
  entry.draw();
  return entry;
}

/** Redraws what is still on the page, and forgets the rest. */
function redrawPlots() {
  for (const [box, entry] of plots) {
    if (box.isConnected) entry.draw();
    else {
      entry.plot?.destroy();
      plots.delete(box);
    }
  }
}

/** Shows a text at a place of a chart, within its box. */
function showTip(box, left, top, text) {
  let tip = box.querySelector(".tip");
  if (!tip) box.append(tip = element("div", { className: "tip", "aria-hidden": "true" }));
  tip.hidden = false;
  tip.textContent = text;
  const x = left + 14 + tip.offsetWidth > box.clientWidth ? left - 14 - tip.offsetWidth : left + 14;
  tip.style.left = `${Math.max(0, x)}px`;
  tip.style.top = `${Math.max(0, Math.min(top, box.clientHeight - tip.offsetHeight - 4))}px`;
}

function hideTip(box) {
  const tip = box.querySelector(".tip");
  if (tip) tip.hidden = true;
}

/** Vertical lines from the lower to the upper ends of intervals. */
function drawBars(u, x, lows, highs, colour) {
  const { ctx } = u;
  ctx.save();
  ctx.strokeStyle = colour;
  ctx.lineWidth = 1.25 * devicePixelRatio;
  ctx.beginPath();
  x.forEach((at, i) => {
    if (lows[i] === null || highs[i] === null || lows[i] === undefined || highs[i] === undefined) return;
    const left = Math.round(u.valToPos(at, "x", true));
    const clip = (value) => Math.min(u.bbox.top + u.bbox.height, Math.max(u.bbox.top, u.valToPos(value, "y", true)));
    ctx.moveTo(left, clip(lows[i]));
    ctx.lineTo(left, clip(highs[i]));
  });
  ctx.stroke();
  ctx.restore();
}

/**
 * A range around all finite numbers, with some room; `zero` is in it if asked for. Otherwise it
 * spans a fifth of the largest at least, so that small changes look small.
 */
function roomy(numbers, zero) {
  const finite = numbers.filter((n) => n !== null && n !== undefined && Number.isFinite(n));
  if (zero) finite.push(0);
  if (finite.length === 0) return [0, 1];
  const [low, high] = [Math.min(...finite), Math.max(...finite)];
  const least = zero ? 0 : 0.2 * Math.max(Math.abs(low), Math.abs(high));
  const room = Math.max(0.08 * (high - low), 0.5 * (least - (high - low))) || 1;
  return [low - room, high + room];
}

/**
 * A chart of values over commits, evenly spaced: {labels, series: [{label, colour, values, lows,
 * highs}], zero, format, tip(index)}.
 */
function trend(box, spec) {
  return keepPlot(box, () => {
    const count = spec.labels.length;
    const x = spec.labels.map((_, index) => index);
    const range = roomy(spec.series.flatMap((s) => [...s.values, ...s.lows, ...s.highs]), spec.zero);
    const style = axisStyle();
    const every = Math.max(1, Math.ceil(count / Math.max(2, Math.floor(box.clientWidth / 95))));
    const columns = [x];
    const series = [{}];
    const bands = [];
    spec.series.forEach(({ label, colour, values, lows, highs }) => {
      const shade = cssValue(colour);
      const edge = { stroke: "transparent", width: 0, points: { show: false }, spanGaps: true };
      columns.push(lows, highs, values);
      series.push(edge, edge, { label, stroke: shade, width: 1.75, spanGaps: true, points: { show: true, size: 6, fill: shade } });
      const last = series.length - 1;
      bands.push({ series: [last - 1, last - 2], fill: `color-mix(in srgb, ${shade} 20%, transparent)` });
    });
    const move = (u) => {
      const index = u.cursor.idx;
      if (index === null || index === undefined || u.cursor.left < 0) hideTip(box);
      else showTip(box, u.over.offsetLeft + u.valToPos(index, "x"), 4, spec.tip(index));
    };
    return new uPlot({
      width: box.clientWidth, height: box.clientHeight, legend: { show: false }, series, bands,
      scales: { x: { time: false, range: () => [-0.5, count - 0.5] }, y: { range: () => range } },
      axes: [
        { ...style, size: 26, splits: () => x.filter((i) => (count - 1 - i) % every === 0), values: (u, at) => at.map((i) => spec.labels[i]) },
        { ...style, size: 62, splits: (u, i, low, high) => evenTicks(low, high), values: (u, at) => at.map(spec.format) },
      ],
      cursor: { drag: { x: false, y: false }, y: false, points: { show: false } },
      hooks: {
        setCursor: [move],
        draw: [(u) => spec.series.forEach((s) => drawBars(u, x, s.lows, s.highs, cssValue(s.colour)))],
      },
    }, columns, box);
  });
}
