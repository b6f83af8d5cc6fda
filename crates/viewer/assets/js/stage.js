// The picture: cells as sharp squares at one zoom and pan for all methods, the selected pixel, the
// colour bar, and words for those who do not see it.

const stage = { canvas: null, context: null, cells: document.createElement("canvas"), described: null };

/** Largest zoom: a cell of this many screen pixels, or this factor. */
const LARGEST_CELL = 96;
const LARGEST_ZOOM = 8;

/** The zoom of the view shown: `scale` 1 fits it, x and y are the cell at the middle. */
function zoomOf(v) {
  const { kind } = v.view;
  if (!state.zooms[kind]) {
    const { width, height } = v.view.size(v);
    state.zooms[kind] = { scale: 1, x: width / 2, y: height / 2 };
  }
  return state.zooms[kind];
}

/** How cells lie on the canvas, in device pixels: left, top, and the size of a cell. */
function geometry(v) {
  const { canvas } = stage;
  const { width, height, aspect } = v.view.size(v);
  const zoom = zoomOf(v);
  let fit = Math.min(canvas.width / (width * aspect), canvas.height / height);
  // Whole screen pixels per cell look even.
  if (aspect === 1 && fit > 1) fit = Math.floor(fit);
  const cellHeight = fit * zoom.scale;
  const cellWidth = cellHeight * aspect;
  return {
    cellWidth, cellHeight, fit, width, height,
    left: Math.round(canvas.width / 2 - zoom.x * cellWidth),
    top: Math.round(canvas.height / 2 - zoom.y * cellHeight),
  };
}

/** The cell at a place on the canvas (CSS pixels); null outside. */
function cellAt(v, clientX, clientY) {
  const box = stage.canvas.getBoundingClientRect();
  const ratio = stage.canvas.width / box.width;
  const g = geometry(v);
  const x = Math.floor(((clientX - box.left) * ratio - g.left) / g.cellWidth);
  const y = Math.floor(((clientY - box.top) * ratio - g.top) / g.cellHeight);
  return x >= 0 && y >= 0 && x < g.width && y < g.height ? { x, y } : null;
}

/** Where the middle of a cell is on the page (CSS pixels). */
function placeOf(v, x, y) {
  const box = stage.canvas.getBoundingClientRect();
  const ratio = stage.canvas.width / box.width;
  const g = geometry(v);
  return {
    x: box.left + (g.left + (x + 0.5) * g.cellWidth) / ratio,
    y: box.top + (g.top + (y + 0.5) * g.cellHeight) / ratio,
  };
}

/** Sets zoom and pan, within reason. */
function setZoom(v, scale, x, y) {
  const { kind } = v.view;
  const g = geometry(v);
  const largest = Math.max(LARGEST_ZOOM, LARGEST_CELL / g.fit);
  const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
  scale = clamp(scale, 1, largest);
  const zoom = scale === 1
    ? { scale, x: g.width / 2, y: g.height / 2 }
    : { scale, x: clamp(x, 0, g.width), y: clamp(y, 0, g.height) };
  update({ zooms: { ...state.zooms, [kind]: zoom } });
}

/** Zooms by a factor around a cell, which stays where it is. */
function zoomBy(v, factor, centre = null) {
  const zoom = zoomOf(v);
  const at = centre ?? v.view.cell(v);
  const x = at.x + 0.5 + (zoom.x - at.x - 0.5) / factor;
  const y = at.y + 0.5 + (zoom.y - at.y - 0.5) / factor;
  setZoom(v, zoom.scale * factor, x, y);
}

/** Paints the cells of the current method into the small canvas; returns the brightest. */
function paintCells(v) {
  const { view, cube } = v;
  const { width, height } = view.size(v);
  const cells = stage.cells;
  cells.width = width;
  cells.height = height;
  const context = cells.getContext("2d");
  const image = context.createImageData(width, height);
  const out = [0, 0, 0];
  const brightest = { x: 0, y: 0, value: -Infinity };
  const white = view.colour ? view.white(v) : 0;
  const gain = white > 0 ? 2 ** state.exposure / white : 1;
  const scale = view.colour ? null : view.scale(v);
  for (let y = 0, at = 0; y < height; y++) {
    for (let x = 0; x < width; x++, at += 4) {
      let value;
      if (view.colour) {
        view.read(v, cube, x, y, out);
        paintColour(image.data, at, out, gain, state.curve);
        value = LUMINANCE[0] * out[0] + LUMINANCE[1] * out[1] + LUMINANCE[2] * out[2];
      } else {
        value = view.read(v, cube, x, y);
        paintScale(image.data, at, scale, value);
      }
      if (value > brightest.value) Object.assign(brightest, { x, y, value });
    }
  }
  context.putImageData(image, 0, 0);
  return { brightest, scale };
}

/** Fits the canvas to its box. */
function fitCanvas() {
  const { canvas } = stage;
  const ratio = window.devicePixelRatio || 1;
  const width = Math.max(1, Math.round(canvas.clientWidth * ratio));
  const height = Math.max(1, Math.round(canvas.clientHeight * ratio));
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
    return true;
  }
  return false;
}

function drawStage(v) {
  fitCanvas();
  const { canvas, context } = stage;
  const { brightest, scale } = paintCells(v);
  const g = geometry(v);
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.imageSmoothingEnabled = false;
  context.drawImage(stage.cells, g.left, g.top, g.width * g.cellWidth, g.height * g.cellHeight);
  drawCrosshair(v, g);
  drawScale(scale ?? greyScale(v));
  byId("badge").textContent = badge(v);
  canvas.style.touchAction = zoomOf(v).scale > 1 ? "none" : "pan-x pan-y";
  describe(v, brightest, scale);
}

/** Marks the selected cell, readable on any colour. */
function drawCrosshair(v, g) {
  const { context } = stage;
  const ratio = window.devicePixelRatio || 1;
  const cell = v.view.cell(v);
  const x = g.left + cell.x * g.cellWidth;
  const y = g.top + cell.y * g.cellHeight;
  const arm = 9 * ratio;
  for (const [width, colour] of [[3 * ratio, "rgba(0,0,0,.75)"], [1.25 * ratio, "#fff"]]) {
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.strokeRect(x - ratio, y - ratio, g.cellWidth + 2 * ratio, g.cellHeight + 2 * ratio);
    const middle = { x: x + g.cellWidth / 2, y: y + g.cellHeight / 2 };
    context.beginPath();
    for (const [dx, dy, length] of [[1, 0, g.cellWidth / 2], [0, 1, g.cellHeight / 2]]) {
      for (const side of [-1, 1]) {
        const from = side * (length + 2 * ratio);
        const to = side * (length + arm);
        context.moveTo(middle.x + dx * from, middle.y + dy * from);
        context.lineTo(middle.x + dx * to, middle.y + dy * to);
      }
    }
    context.stroke();
  }
}

/** The bar of a view of radiance: greys as the tone curve makes them, up to what it shows white. */
function greyScale(v) {
  const white = v.view.white(v) * 2 ** -state.exposure;
  const { grey, from, to, log } = CURVES[state.curve];
  const map = new Uint8ClampedArray(256 * 3);
  for (let i = 0; i < 256; i++) {
    const x = log ? from * (to / from) ** (i / 255) : from + ((to - from) * i) / 255;
    map.fill(255 * encodeSrgb(grey(x)), 3 * i, 3 * i + 3);
  }
  return { map, low: from * white, high: to * white, log, label: `${v.unitKnown ? "radiance" : "value"} [${v.view.unit(v)}]` };
}

/** The bar that tells what colours mean. */
function drawScale(scale) {
  const bar = byId("scale-bar");
  const context = bar.getContext("2d");
  const image = context.createImageData(256, 1);
  const map = COLOUR_MAPS[scale.map] ?? scale.map;
  for (let i = 0; i < 256; i++) {
    image.data.set(map.subarray(3 * i, 3 * i + 3), 4 * i);
    image.data[4 * i + 3] = 255;
  }
  context.putImageData(image, 0, 0);
  const text = scale.text ?? ((value) => digits(value));
  byId("scale-low").textContent = text(scale.low);
  byId("scale-high").textContent = text(scale.high);
  byId("scale-label").textContent = scale.label + (scale.log ? ", logarithmic" : "");
  bar.setAttribute("aria-label", `Colour bar from ${text(scale.low)} to ${text(scale.high)}: ${scale.label}`);
}

/** A few words on the picture. */
function badge(v) {
  const time = v.view.moves ? v.timeOfBin(state.bin) : v.view.label;
  return `${v.cube.entry.label} · ${time}`;
}

/** Tells in words what is seen, once things have come to rest. */
function describe(v, brightest, scale) {
  clearTimeout(stage.described);
  const exposure = v.view.colour
    ? `exposure ${state.exposure >= 0 ? "+" : "−"}${Math.abs(state.exposure)} stops, ${state.curve} tone curve`
    : `colours from ${(scale.text ?? digits)(scale.low)} to ${(scale.text ?? digits)(scale.high)}`;
  const text = scale?.text ?? ((value) => v.withUnit(digits(value), v.view.unit(v)));
  const most = v.view.colour ? "brightest cell" : "largest value";
  const at = v.view.place(v, brightest.x, brightest.y);
  const where = v.view.kind === "image"
    ? `column ${v.column(at.x)}, row ${v.row(at.y)}`
    : `${at.x === undefined ? `row ${v.row(at.y)}` : `column ${v.column(at.x)}`}, ${v.timeOfBin(at.bin)}`;
  const found = brightest.value > -Infinity
    ? `${most} ${text(brightest.value)} at ${where}`
    : "nothing to see";
  const words = `${describeView(v)}. Method ${v.cube.entry.label}, ${exposure}, ${found}.`;
  const say = () => stage.canvas.setAttribute("aria-label", words);
  if (state.playing) stage.described = setTimeout(say, 400);
  else say();
}
