// One result: its cells, images, standard errors, and what is computed from them once.

/** Light has arrived in a pixel once a bin reaches this part of its brightest one. */
const ARRIVAL = 0.1;

/** Weights of linear sRGB in luminance (Rec. 709). */
const LUMINANCE = [0.2126, 0.7152, 0.0722];

class Cube {
  /** Unpacks a method of the manifest. */
  static async unpack(manifest, entry, index) {
    const { width, height, bins, channels } = manifest.shape;
    const pixels = width * height;
    const read = (streams, narrow) => unpackChannels(streams, narrow, width, pixels);
    const cube = new Cube();
    Object.assign(cube, { entry, index, width, height, bins, channels, pixels });
    cube.values = valueTable(manifest.code.steps, manifest.code.offset);
    cube.ratios = errorTable(manifest.code.error_steps, manifest.code.error_offset);
    const images = valueTable(manifest.code.image_steps, manifest.code.offset);
    const image = async (streams) =>
      (await read(streams, false)).map((codes) => Float64Array.from(codes, (code) => images[code]));
    cube.codes = await read(entry.cube, false);
    cube.errors = await read(entry.errors, true);
    cube.steady = await image(entry.steady);
    cube.before = await image(entry.before);
    cube.after = await image(entry.after);
    return cube;
  }

  get hasErrors() {
    return this.errors.length > 0;
  }

  /** Standard errors on each side of a 95 % interval; NaN if their number of batches allows none. */
  get interval() {
    return this.entry.interval ?? NaN;
  }

  /** A cell's value in one channel. */
  value(bin, pixel, channel) {
    return this.values[this.codes[channel][bin * this.pixels + pixel]];
  }

  /** The standard error of a cell in one channel; NaN where unknown. */
  standardError(bin, pixel, channel) {
    if (!this.hasErrors) return NaN;
    const at = bin * this.pixels + pixel;
    const ratio = this.ratios[this.errors[channel][at]];
    return ratio === 0 ? 0 : ratio * Math.abs(this.values[this.codes[channel][at]]);
  }

  /** A cell as the chart and the readout want it: channel "0", "1", "2" or "luminance". */
  reading(bin, pixel, channel) {
    if (channel !== "luminance") return this.value(bin, pixel, Number(channel));
    if (this.channels === 1) return this.value(bin, pixel, 0);
    let sum = 0;
    for (let c = 0; c < 3; c++) sum += LUMINANCE[c] * this.value(bin, pixel, c);
    return sum;
  }

  /** Its standard error; of luminance, that of channels that err together: the widest. */
  readingError(bin, pixel, channel) {
    if (channel !== "luminance") return this.standardError(bin, pixel, Number(channel));
    if (this.channels === 1) return this.standardError(bin, pixel, 0);
    let sum = 0;
    for (let c = 0; c < 3; c++) sum += LUMINANCE[c] * this.standardError(bin, pixel, c);
    return sum;
  }

  /** Luminance of a pixel of an image: "steady", "before", "after". */
  imageLuminance(name, pixel) {
    const image = this[name];
    if (image.length === 0) return 0;
    if (this.channels === 1) return image[0][pixel];
    return LUMINANCE[0] * image[0][pixel] + LUMINANCE[1] * image[1][pixel] + LUMINANCE[2] * image[2][pixel];
  }

  /** When light arrives, its mean time and that of its peak for each pixel [edges' unit]; NaN where dark. */
  times(edges) {
    if (this.cachedTimes) return this.cachedTimes;
    const mean = new Float64Array(this.pixels);
    const peak = new Float64Array(this.pixels);
    const arrival = new Float64Array(this.pixels);
    for (let pixel = 0; pixel < this.pixels; pixel++) {
      let energy = 0;
      let moment = 0;
      let best = 0;
      let bestTime = NaN;
      for (let bin = 0; bin < this.bins; bin++) {
        const value = this.reading(bin, pixel, "luminance");
        if (!(value > 0)) continue;
        const centre = 0.5 * (edges[bin] + edges[bin + 1]);
        energy += value;
        moment += value * centre;
        if (value > best) {
          best = value;
          bestTime = centre;
        }
      }
      mean[pixel] = energy > 0 ? moment / energy : NaN;
      peak[pixel] = bestTime;
      arrival[pixel] = this.arrivalTime(edges, pixel, best);
    }
    this.cachedTimes = { mean, peak, arrival };
    return this.cachedTimes;
  }

  /** Centre of the first bin that reaches the stated part of the pixel's brightest bin. */
  arrivalTime(edges, pixel, brightest) {
    if (!(brightest > 0)) return NaN;
    let bin = 0;
    while (!(this.reading(bin, pixel, "luminance") >= ARRIVAL * brightest)) bin++;
    return 0.5 * (edges[bin] + edges[bin + 1]);
  }
}

/** The value that a part of sorted-by-size positive values does not exceed; 0 without any. */
function percentile(values, part) {
  const lit = Float64Array.from(values.filter((v) => v > 0 && Number.isFinite(v))).sort();
  if (lit.length === 0) return 0;
  return lit[Math.min(lit.length - 1, Math.max(0, Math.ceil(part * lit.length) - 1))];
}
