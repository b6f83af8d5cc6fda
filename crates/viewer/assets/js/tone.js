// From radiance to the screen: exposure, tone curve, sRGB.
//
// Display white at 0 stops is the luminance that 99 % of the lit cells of a frame, or of the whole
// cube, do not exceed (95 % for images over all time, where lamps take a larger part). It comes from
// the reference, or from the first method without one: all methods share it.
//
// The curves are those of all our pictures and videos (the Rust type `tpb_film::ToneMap`, whose
// documentation derives them): the same names make the same pictures. With x = radiance over white:
//
//   linear  min(x, 1), each channel by itself
//   log     the encoded grey ln(1 + 1000 x)/ln(10001) of the luminance: white at x = 10; colours keep
//           their ratios, and turn pale only where they would leave the display
//   filmic  x (2.51 x + 0.03)/(x (2.43 x + 0.59) + 0.14), each channel by itself: a fit to the ACES
//           curve by Narkowicz (2015), white at x = 7.24

/** Where the logarithmic curve bends to a straight line, and the x that it shows white. */
const LOG_KNEE = 1e3;
const LOG_WHITE = 10;

/** Curves: words; the linear display value, 0 to 1, of x; the range of x that a bar shows. */
const CURVES = {
  linear: {
    label: "what is above white is white",
    grey: (x) => Math.min(1, Math.max(0, x)),
    from: 0, to: 1,
  },
  log: {
    label: "a quarter of the greys for each decade, from a thousandth of white to ten times white",
    grey: (x) => decodeSrgb(Math.min(1, Math.log1p(LOG_KNEE * Math.max(0, x)) / Math.log1p(LOG_KNEE * LOG_WHITE))),
    from: 1 / LOG_KNEE, to: LOG_WHITE, log: true,
  },
  filmic: {
    label: "deeper shadows, soft highlights up to seven times white",
    grey: (x) => (x > 0 ? Math.min(1, (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)) : 0),
    from: 0, to: 7.24,
  },
};

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

/** sRGB of linear values in 1/4095 steps. */
const SRGB = Uint8ClampedArray.from({ length: 4096 }, (_, i) => Math.round(255 * encodeSrgb(i / 4095)));

/** Turns x of three channels into linear display values, in place. */
function applyCurve(rgb, curve) {
  const { grey } = CURVES[curve];
  if (curve !== "log") {
    for (let c = 0; c < 3; c++) rgb[c] = grey(rgb[c]);
    return;
  }
  for (let c = 0; c < 3; c++) rgb[c] = Math.max(0, rgb[c]);
  const luminance = LUMINANCE[0] * rgb[0] + LUMINANCE[1] * rgb[1] + LUMINANCE[2] * rgb[2];
  const shown = grey(luminance);
  const factor = luminance > 0 ? shown / luminance : 0;
  const largest = factor * Math.max(rgb[0], rgb[1], rgb[2]);
  // Towards the grey of the same luminance, until all channels are on the display.
  const kept = largest > 1 ? (1 - shown) / (largest - shown) : 1;
  for (let c = 0; c < 3; c++) rgb[c] = shown + (factor * rgb[c] - shown) * kept;
}

/** Sample of a linear display value. */
const sample = (linear) => SRGB[Math.min(4095, Math.max(0, (linear * 4095 + 0.5) | 0))];

const shade = [0, 0, 0];

/** Writes a colour (r, g, b radiance) into an image: `gain` is 1 over white. */
function paintColour(data, at, rgb, gain, curve) {
  const [r, g, b] = rgb;
  if (!(Number.isFinite(r) && Number.isFinite(g) && Number.isFinite(b))) {
    [data[at], data[at + 1], data[at + 2]] = ODD_COLOUR;
    data[at + 3] = 255;
    return;
  }
  [shade[0], shade[1], shade[2]] = [r * gain, g * gain, b * gain];
  applyCurve(shade, curve);
  data[at] = sample(shade[0]);
  data[at + 1] = sample(shade[1]);
  data[at + 2] = sample(shade[2]);
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
