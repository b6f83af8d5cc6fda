// Error measures of a luminance x against the reference's r, for false colours.
//
// ε is a stated part of the mean of r over the lit cells of the cube (or of the steady image), the
// same for all methods, so that colours compare between them.

const METRICS = {
  signed: {
    label: "signed relative",
    formula: "(x − r)/(|r| + ε)",
    of: (x, r, eps) => (x - r) / (Math.abs(r) + eps),
    scale: { map: "balance", low: -1, high: 1 },
  },
  relative: {
    label: "relative",
    formula: "|x − r|/(|r| + ε)",
    of: (x, r, eps) => Math.abs(x - r) / (Math.abs(r) + eps),
    scale: { map: "heat", low: 0, high: 1 },
  },
  squared: {
    label: "relative, squared",
    formula: "(x − r)²/(r² + ε²)",
    of: (x, r, eps) => (x - r) ** 2 / (r * r + eps * eps),
    scale: { map: "heat", low: 1e-5, high: 1, log: true },
  },
  smape: {
    label: "symmetric (SMAPE)",
    formula: "2|x − r|/(|x| + |r| + ε)",
    of: (x, r, eps) => (2 * Math.abs(x - r)) / (Math.abs(x) + Math.abs(r) + eps),
    scale: { map: "heat", low: 0, high: 2 },
  },
  absolute: {
    label: "absolute",
    formula: "|x − r|",
    of: (x, r) => Math.abs(x - r),
    scale: null, // from the data, the same for all methods
  },
  z: {
    label: "in standard errors",
    formula: "(x − r)/√(s² + s_r²)",
    of: null, // needs standard errors
    scale: { map: "balance", low: -4, high: 4 },
  },
};

/** ε for errors of frames. */
function cubeEpsilon(viewer) {
  if (viewer.cachedEpsilon === undefined) {
    const { reference } = viewer;
    let sum = 0;
    let lit = 0;
    for (let bin = 0; bin < viewer.bins; bin++) {
      for (let pixel = 0; pixel < reference.pixels; pixel++) {
        const r = Math.abs(reference.reading(bin, pixel, "luminance"));
        if (!(r > 0)) continue;
        sum += r;
        lit++;
      }
    }
    viewer.cachedEpsilon = lit ? (viewer.manifest.epsilon * sum) / lit : 0;
  }
  return viewer.cachedEpsilon;
}

/** ε for errors of the steady image. */
function steadyEpsilon(viewer) {
  if (viewer.cachedSteadyEpsilon === undefined) {
    const { reference } = viewer;
    let sum = 0;
    let lit = 0;
    for (let pixel = 0; pixel < reference.pixels; pixel++) {
      const r = Math.abs(reference.imageLuminance("steady", pixel));
      if (!(r > 0)) continue;
      sum += r;
      lit++;
    }
    viewer.cachedSteadyEpsilon = lit ? (viewer.manifest.epsilon * sum) / lit : 0;
  }
  return viewer.cachedSteadyEpsilon;
}

/** The error of one cell of a frame. */
function frameError(viewer, cube, bin, pixel) {
  const { reference } = viewer;
  const x = cube.reading(bin, pixel, "luminance");
  const r = reference.reading(bin, pixel, "luminance");
  if (state.metric !== "z") return METRICS[state.metric].of(x, r, cubeEpsilon(viewer));
  // Where both share random numbers, their standard errors do not tell that of the difference.
  if (!cube.entry.independent) return NaN;
  const s = cube.readingError(bin, pixel, "luminance");
  const sr = reference.hasErrors ? reference.readingError(bin, pixel, "luminance") : 0;
  return (x - r) / Math.sqrt(s * s + sr * sr);
}

/** The error of one pixel of the steady image; its standard errors are not kept. */
function steadyError(viewer, cube, pixel) {
  if (state.metric === "z") return NaN;
  const x = cube.imageLuminance("steady", pixel);
  const r = viewer.reference.imageLuminance("steady", pixel);
  return METRICS[state.metric].of(x, r, steadyEpsilon(viewer));
}

/** The scale of the chosen error: that of its measure, or from all methods together. */
function errorScale(viewer, error) {
  const metric = METRICS[state.metric];
  const label = `${metric.label} error, ${metric.formula}`;
  if (metric.scale) return { ...metric.scale, label };
  let high = 0;
  for (const cube of viewer.cubes) {
    if (cube === viewer.reference) continue;
    const values = [];
    for (let pixel = 0; pixel < cube.pixels; pixel++) values.push(error(cube, pixel));
    high = Math.max(high, percentile(values, 0.99));
  }
  return { map: "heat", low: 0, high: high || 1, label: `${label} [${viewer.view.name === "error" ? viewer.unit : viewer.imageUnit}]` };
}
