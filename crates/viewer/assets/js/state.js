// What is shown.

Object.assign(state, {
  method: 0,
  view: "frame",
  bin: 0,
  x: 0,
  y: 0,
  hover: null, // a cell of the view under the mouse: {x, y}
  exposure: 0, // stops
  follow: false,
  curve: "linear",
  metric: "signed",
  channel: "luminance",
  chartKind: "pixel",
  logAxis: false,
  chartZoom: false, // near the slider's time
  playing: false,
  speed: 20, // bins per second
  zooms: {}, // per kind of view: {scale, x, y}
});

/**
 * Reads a link such as `#method=beams&view=error&bin=40&pixel=12,30&exposure=1`. Bins and pixels are
 * those of the result, from 0, also where the cubes of this page are reduced.
 */
function readLink(viewer) {
  const link = new URLSearchParams(location.hash.slice(1));
  const changes = {};
  const [side, bins] = viewer.manifest.factors;
  const whole = (text, factor, end) => Math.min(Math.max(0, Math.floor(Math.round(Number(text)) / factor) || 0), end - 1);
  const method = viewer.cubes.findIndex((cube) => cube.entry.key === link.get("method"));
  if (method >= 0) changes.method = method;
  if (viewer.views.some((view) => view.name === link.get("view"))) changes.view = link.get("view");
  if (link.has("bin") && viewer.bins > 0) changes.bin = whole(link.get("bin"), bins, viewer.bins);
  const pixel = (link.get("pixel") ?? "").split(",");
  if (pixel.length === 2) {
    changes.x = whole(pixel[0], side, viewer.width);
    changes.y = whole(pixel[1], side, viewer.height);
  }
  if (link.get("curve") in CURVES) changes.curve = link.get("curve");
  if (link.has("exposure")) changes.exposure = Number(link.get("exposure")) || 0;
  if (["dark", "light"].includes(link.get("theme"))) document.documentElement.dataset.theme = link.get("theme");
  update(changes);
}
