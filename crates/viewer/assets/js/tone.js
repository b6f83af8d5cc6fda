// From radiance to the screen: exposure, tone curve, sRGB.
//
// Display white at 0 stops is the luminance that 99 % of the lit cells of a frame, or of the whole
// cube, do not exceed (95 % for images over all time, where lamps take a larger part). It comes from
// the reference, or from the first method without one: all methods share it.

const CURVES = {
  linear: "linear: what is above white is white",
  log: "logarithmic: four decades below white, evenly spaced",
  filmic: "filmic: a shoulder for highlights",
};

/** Decades below white that the logarithmic curve shows. */
const DECADES = 4;

/** Cells that a cube's white is told from. */
const WHITE_SAMPLE = 400000;

/** Luminance of display white over the whole cube. */
function cubeWhite(cube) {
  if (cube.cachedWhite !== undefined) return cube.cachedWhite;
  const count = cube.bins * cube.pixels;
  // A step that shares no factor with rows: an odd number near the ratio.
  const step = Math.max(1, Math.floor(count / WHITE_SAMPLE)) | 1;
  const values = [];
  for (let i = 0; i < count; i += step) {
    values.push(cube.reading(Math.floor(i / cube.pixels), i % cube.pixels, "luminance"));
  }
  cube.cachedWhite = percentile(values, 0.99);
  return cube.cachedWhite;
}

/** Luminance of display white of one frame. */
function frameWhite(cube, bin) {
  cube.frameWhites ??= new Map();
  if (!cube.frameWhites.has(bin)) {
    const values = [];
    for (let pixel = 0; pixel < cube.pixels; pixel++) values.push(cube.reading(bin, pixel, "luminance"));
    cube.frameWhites.set(bin, percentile(values, 0.99));
  }
  return cube.frameWhites.get(bin);
}

/** Luminance of display white of an image over all time. */
function imageWhite(cube, name) {
  const key = `${name}White`;
  if (cube[key] === undefined) {
    const values = [];
    for (let pixel = 0; pixel < cube.pixels; pixel++) values.push(cube.imageLuminance(name, pixel));
    cube[key] = percentile(values, 0.95);
  }
  return cube[key];
}

/** The linear display value of a relative luminance; 1 is white. */
const toneCurves = {
  linear: (v) => v,
  log: (v) => (v > 0 ? decodeSrgb(Math.min(1, Math.max(0, 1 + Math.log10(v) / DECADES))) : 0),
  // A rational fit of the ACES curve (Narkowicz 2015), scaled so that its white is at 4.
  filmic: (v) => (v * (2.51 * v + 0.03)) / (v * (2.43 * v + 0.59) + 0.14),
};

/** sRGB of linear values in 1/4095 steps. */
const SRGB = Uint8ClampedArray.from({ length: 4096 }, (_, i) => Math.round(255 * encodeSrgb(i / 4095)));

/** Writes a colour (r, g, b radiance) into an image: `gain` is 1 over white. */
function paintColour(data, at, rgb, gain, curve) {
  let [r, g, b] = rgb;
  if (!(Number.isFinite(r) && Number.isFinite(g) && Number.isFinite(b))) {
    [data[at], data[at + 1], data[at + 2]] = ODD_COLOUR;
    data[at + 3] = 255;
    return;
  }
  r *= gain;
  g *= gain;
  b *= gain;
  if (curve !== "linear") {
    // The curve acts on luminance, so that hues stay.
    const luminance = LUMINANCE[0] * r + LUMINANCE[1] * g + LUMINANCE[2] * b;
    const factor = luminance > 0 ? toneCurves[curve](luminance) / luminance : 0;
    r *= factor;
    g *= factor;
    b *= factor;
  }
  data[at] = SRGB[Math.min(4095, Math.max(0, (r * 4095 + 0.5) | 0))];
  data[at + 1] = SRGB[Math.min(4095, Math.max(0, (g * 4095 + 0.5) | 0))];
  data[at + 2] = SRGB[Math.min(4095, Math.max(0, (b * 4095 + 0.5) | 0))];
  data[at + 3] = 255;
}

/** Writes the colour of a value on a scale into an image; dark where there is no value. */
function paintScale(data, at, scale, value) {
  const where = position(scale, value);
  const map = COLOUR_MAPS[scale.map];
  const from = 3 * Math.round(255 * where);
  const known = !Number.isNaN(where);
  data[at] = known ? map[from] : 0;
  data[at + 1] = known ? map[from + 1] : 0;
  data[at + 2] = known ? map[from + 2] : 0;
  data[at + 3] = 255;
}
