// Unpacks, builds the controls, and ties drawing to the state.

/** What all parts share beside the state. */
class Viewer {
  constructor(manifest, cubes) {
    Object.assign(this, manifest.shape, { manifest, cubes, edges: manifest.edges });
    this.time = new TimeUnit(manifest);
    this.reference = cubes.length > 1 ? cubes.find((cube) => cube.entry.reference) ?? null : null;
    /** Whom exposure and scales are told from. */
    this.leader = this.reference ?? cubes[0];
    this.energies = manifest.quantity === "bin_energy";
    const unknown = cubes.filter(({ entry }) => !entry.unit_known).map(({ entry }) => entry.label);
    this.unitKnown = unknown.length < cubes.length;
    const unit = (text) => {
      if (!this.unitKnown) return "unit unknown";
      return unknown.length ? `${text}, if that is the unit of ${unknown.join(", ")}` : text;
    };
    /** Of the cells of the cube, and of the images beside it. */
    this.unit = unit(this.energies ? "W m⁻² sr⁻¹ per bin" : "W m⁻² sr⁻¹");
    this.imageUnit = unit("W m⁻² sr⁻¹");
    this.views = viewsFor(this);
  }

  get cube() {
    return this.cubes[state.method];
  }

  get view() {
    return this.views.find((view) => view.name === state.view) ?? this.views[0];
  }

  /** The time of a bin: its centre; of radiance, its upper edge. */
  timeOfBin(bin) {
    return this.manifest.timed ? this.timeBetween(this.edges, bin) : this.bin(bin);
  }

  /** The same between any edges. */
  timeBetween(edges, bin) {
    const [low, high] = [edges[bin], edges[bin + 1]];
    if (!this.manifest.timed) return this.time.text(low);
    return this.time.text(this.energies ? 0.5 * (low + high) : high);
  }

  /** A value with its unit, if that is known. */
  withUnit(text, unit) {
    return this.unitKnown ? `${text} ${unit}`.trim() : text;
  }

  /** Columns, rows or bins of the result that a shown one stands for, from 0: "7", or "14–15" of a reduced cube. */
  named(at, side, end) {
    const last = Math.min((at + 1) * side, end) - 1;
    return last > at * side ? `${at * side}–${last}` : String(at * side);
  }

  column(x) {
    return this.named(x, this.manifest.factors[0], this.manifest.rendered.width);
  }

  row(y) {
    return this.named(y, this.manifest.factors[0], this.manifest.rendered.height);
  }

  /** "bin 7", "bins 14–15". */
  bin(bin) {
    const name = this.named(bin, this.manifest.factors[1], this.manifest.rendered.bins);
    return `${name.includes("–") ? "bins" : "bin"} ${name}`;
  }

  /** A bin among all. */
  binOfAll(bin) {
    return `${this.bin(bin)} of 0–${this.manifest.rendered.bins - 1}`;
  }

  /** A bin in which much of the image is lit. */
  brightBin() {
    const step = Math.max(1, Math.floor((this.bins * this.leader.pixels) / 1e6));
    const level = 0.1 * cubeWhite(this.leader);
    let best = 0;
    let most = -1;
    for (let bin = 0; bin < this.bins; bin++) {
      let lit = 0;
      for (let p = 0; p < this.leader.pixels; p += step) if (this.leader.reading(bin, p, "luminance") > level) lit++;
      if (lit > most) [best, most] = [bin, lit];
    }
    return best;
  }
}

function tie(v) {
  const look = ["method", "view", "bin", "x", "y", "exposure", "follow", "curve", "metric", "zooms", "theme", "size"];
  onChange(look, () => drawStage(v));
  onChange([...look, "channel", "chartKind", "logAxis", "chartZoom", "playing", "speed"], () => syncControls(v));
  onChange(["hover", "method", "view", "bin", "x", "y", "metric"], () => drawReadout(v));
  const curves = ["x", "y", "channel", "chartKind", "logAxis", "chartZoom", "method", "theme", "size"];
  onChange([...curves, "bin"], (changes) => {
    if (curves.some((name) => changes.has(name))) drawChart(v);
    else redrawTimeLine();
  });
}

function drawAll(v) {
  syncControls(v);
  drawStage(v);
  drawReadout(v);
  drawChart(v);
  drawNumbers(v);
  drawNotes(v);
  drawProvenance(v);
  drawPacking(v);
}

async function start() {
  const manifest = JSON.parse(byId("manifest").textContent);
  const cubes = [];
  for (const [index, entry] of manifest.methods.entries()) {
    byId("loading").textContent = `Unpacking ${entry.label}, ${index + 1} of ${manifest.methods.length}…`;
    cubes.push(await Cube.unpack(manifest, entry, index));
  }
  const v = new Viewer(manifest, cubes);
  Object.assign(state, {
    view: v.views[0].name, bin: v.brightBin(), x: Math.floor(v.width / 2), y: Math.floor(v.height / 2),
  });
  stage.canvas = byId("stage");
  stage.context = stage.canvas.getContext("2d");
  byId("main").hidden = false;
  byId("loading").hidden = true;
  buildControls(v);
  readLink(v);
  await settled();
  tie(v);
  drawAll(v);
  listenToPointers(v);
  listenToKeys(v);
  let size = 0;
  const watcher = new ResizeObserver(() => update({ size: ++size }));
  watcher.observe(byId("stage-box"));
  watcher.observe(byId("chart"));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", (event) => update({ theme: `system ${event.matches}` }));
  addEventListener("hashchange", () => readLink(v));
  /** For scripts and tests: the state, and what is shown. */
  window.tpbViewer = { state, update, settled, viewer: v, stage, chart, digits, placeOf: (x, y) => placeOf(v, x, y) };
}

start().catch((error) => {
  byId("loading").hidden = false;
  byId("loading").textContent = `This page cannot be shown: ${error.message}. It needs a browser of 2023 or later.`;
  console.error(error);
});
