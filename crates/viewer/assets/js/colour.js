// Perceptual colour maps, made in OKLCh (Ottosson 2020): lightness is even by construction.
//
// "heat" for magnitudes and "time" for times of arrival run from dark to light; "balance" for signed
// quantities is darkest at its middle. Chroma is lowered where sRGB does not reach it.

/** Linear sRGB of an OKLCh colour, hue in degrees. */
function linearFromOklch(lightness, chroma, hue) {
  const a = chroma * Math.cos((hue * Math.PI) / 180);
  const b = chroma * Math.sin((hue * Math.PI) / 180);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
}

/** A linear display value in [0, 1] with the curve of sRGB (IEC 61966-2-1). */
function encodeSrgb(linear) {
  if (linear <= 0) return 0;
  if (linear >= 1) return 1;
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
}

/** The inverse of `encodeSrgb`. */
function decodeSrgb(encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : ((encoded + 0.055) / 1.055) ** 2.4;
}

/** 8-bit sRGB of an OKLCh colour, with as much of its chroma as there is. */
function srgbFromOklch(lightness, chroma, hue) {
  let low = 0;
  let high = chroma;
  const inside = (c) => linearFromOklch(lightness, c, hue).every((v) => v >= -1e-4 && v <= 1.0001);
  if (inside(chroma)) low = chroma;
  else for (let i = 0; i < 20; i++) {
    const middle = 0.5 * (low + high);
    if (inside(middle)) low = middle;
    else high = middle;
  }
  return linearFromOklch(lightness, low, hue).map((v) => Math.round(255 * encodeSrgb(v)));
}

/** 256 colours of a path through OKLCh. */
function colourMap(path) {
  const map = new Uint8ClampedArray(256 * 3);
  for (let i = 0; i < 256; i++) map.set(srgbFromOklch(...path(i / 255)), 3 * i);
  return map;
}

const COLOUR_MAPS = {
  heat: colourMap((t) => [0.12 + 0.84 * t, 0.19 * Math.sin(Math.PI * (0.1 + 0.78 * t)), 300 + 165 * t]),
  time: colourMap((t) => [0.3 + 0.63 * t, 0.15, 290 - 190 * t]),
  balance: colourMap((t) => {
    const side = 2 * t - 1;
    const size = Math.abs(side);
    return [0.16 + 0.72 * size, 0.17 * size ** 0.7, side < 0 ? 245 : 55];
  }),
};

/** Colour of cells that are not finite: seen at once, in no map. */
const ODD_COLOUR = [255, 0, 255];

/** Where a value lies on a scale {low, high, log}: 0 to 1, NaN for no value. */
function position(scale, value) {
  if (Number.isNaN(value)) return NaN;
  const at = scale.log
    ? (Math.log10(Math.max(value, scale.low * 1e-3)) - Math.log10(scale.low)) / (Math.log10(scale.high) - Math.log10(scale.low))
    : (value - scale.low) / (scale.high - scale.low);
  return Math.min(1, Math.max(0, at));
}
