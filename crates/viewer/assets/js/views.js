// Views: what the picture shows. A view has
//
//   name, label     for state and buttons
//   kind            views of one kind share zoom and pan: "image", "xt", "yt"
//   size(v)         columns and rows of cells, and `aspect`: width of a cell over its height
//   colour(v)       true if cells are radiance (r, g, b), false if they are numbers on a scale
//   read(v, cube, x, y, out)  the cell: fills out[0..2], or returns the number
//   error(v, cube, x, y)      standard error of a number or luminance, NaN where unknown
//   white(v)        luminance of display white (colour views)
//   scale(v)        {map, low, high, log, label, text} (number views)
//   cell(v), place(v, x, y)   where the selected pixel and bin lie, and the way back
//   unit(v)         of what `read` gives

const imageSize = (v) => ({ width: v.width, height: v.height, aspect: 1 });
const imageCell = () => ({ x: state.x, y: state.y });
const imagePlace = (v, x, y) => ({ x, y });
const noError = () => NaN;

function readCell(cube, bin, pixel, out) {
  for (let c = 0; c < 3; c++) out[c] = cube.value(bin, pixel, Math.min(c, cube.channels - 1));
}

function readImage(cube, name, pixel, out) {
  const image = cube[name];
  for (let c = 0; c < 3; c++) out[c] = image.length ? image[Math.min(c, cube.channels - 1)][pixel] : 0;
}

/** A view of radiance over the pixels. */
function imageView(name, label, read, white, more = {}) {
  return {
    name, label, kind: "image", colour: true, size: imageSize, cell: imageCell, place: imagePlace,
    read: (v, cube, x, y, out) => read(v, cube, y * v.width + x, out),
    white, error: noError, unit: (v) => v.unit, ...more,
  };
}

/** A view of numbers over the pixels. */
function mapView(name, label, read, scale, more = {}) {
  return {
    name, label, kind: "image", colour: false, size: imageSize, cell: imageCell, place: imagePlace,
    read: (v, cube, x, y) => read(v, cube, y * v.width + x),
    scale, error: noError, unit: () => "", ...more,
  };
}

/** Early and late: 1 % and 99 % of the pixels' times, by the leading method. */
function timeScale(v, which) {
  const key = `${which}Scale`;
  if (!v[key]) {
    const times = Array.from(v.leader.times(v.edges)[which]).filter((t) => !Number.isNaN(t)).sort((a, b) => a - b);
    const at = (part) => times[Math.min(times.length - 1, Math.floor(part * times.length))];
    const [low, high] = times.length ? [at(0.01), at(0.99)] : [0, 1];
    v[key] = { map: "time", low, high: high > low ? high : low + 1, text: (t) => v.time.text(t) };
  }
  return { ...v[key], label: TIME_LABELS[which] };
}

const TIME_LABELS = {
  arrival: `arrival: first bin that reaches ${100 * ARRIVAL} % of the pixel's brightest`,
  mean: "mean time of arrival, weighted by energy",
  peak: "time of the brightest bin",
};

const streakWhite = (v) => cubeWhite(v.leader);

const VIEWS = [
  imageView("frame", "Frame", (v, cube, pixel, out) => readCell(cube, state.bin, pixel, out),
    (v) => (state.follow ? frameWhite(v.leader, state.bin) : cubeWhite(v.leader)),
    {
      timed: true,
      moves: true,
      error: (v, cube, x, y) => cube.readingError(state.bin, y * v.width + x, "luminance"),
    }),
  imageView("steady", "Steady", (v, cube, pixel, out) => readImage(cube, "steady", pixel, out),
    (v) => imageWhite(v.leader, "steady"), { unit: (v) => v.imageUnit }),
  {
    name: "xt", label: "x–t", kind: "xt", colour: true, timed: true,
    size: (v) => ({ width: v.width, height: v.bins, aspect: (0.75 * v.bins) / v.width }),
    read: (v, cube, x, y, out) => readCell(cube, y, state.y * v.width + x, out),
    error: (v, cube, x, y) => cube.readingError(y, state.y * v.width + x, "luminance"),
    white: streakWhite,
    cell: () => ({ x: state.x, y: state.bin }),
    place: (v, x, y) => ({ x, bin: y }),
    unit: (v) => v.unit,
  },
  {
    name: "yt", label: "y–t", kind: "yt", colour: true, timed: true,
    size: (v) => ({ width: v.bins, height: v.height, aspect: (1.3333 * v.height) / v.bins }),
    read: (v, cube, x, y, out) => readCell(cube, x, y * v.width + state.x, out),
    error: (v, cube, x, y) => cube.readingError(x, y * v.width + state.x, "luminance"),
    white: streakWhite,
    cell: () => ({ x: state.bin, y: state.y }),
    place: (v, x, y) => ({ bin: x, y }),
    unit: (v) => v.unit,
  },
  mapView("arrival", "Arrival", (v, cube, pixel) => cube.times(v.edges).arrival[pixel],
    (v) => timeScale(v, "arrival"), { timed: true, energies: true, hint: TIME_LABELS.arrival }),
  mapView("mean", "Mean time", (v, cube, pixel) => cube.times(v.edges).mean[pixel],
    (v) => timeScale(v, "mean"), { timed: true, energies: true }),
  mapView("peak", "Peak time", (v, cube, pixel) => cube.times(v.edges).peak[pixel],
    (v) => timeScale(v, "peak"), { timed: true, energies: true }),
  mapView("error", "Error", (v, cube, pixel) => frameError(v, cube, state.bin, pixel),
    (v) => errorScale(v, (cube, pixel) => frameError(v, cube, state.bin, pixel)),
    { timed: true, moves: true, judges: true }),
  mapView("steady-error", "Steady error", (v, cube, pixel) => steadyError(v, cube, pixel),
    (v) => errorScale(v, (cube, pixel) => steadyError(v, cube, pixel)), { judges: true }),
  imageView("before", "Before", (v, cube, pixel, out) => readImage(cube, "before", pixel, out),
    (v) => imageWhite(v.leader, "before"), { timed: true, unit: (v) => v.imageUnit, hint: "light that arrived before the window" }),
  imageView("after", "After", (v, cube, pixel, out) => readImage(cube, "after", pixel, out),
    (v) => imageWhite(v.leader, "after"), { timed: true, unit: (v) => v.imageUnit, hint: "light that arrived after the window" }),
];

/** The views that these results have. */
function viewsFor(v) {
  return VIEWS.filter((view) =>
    (!view.timed || v.bins > 0) && (!view.judges || v.reference) && (!view.energies || v.energies));
}

/** What a view shows, as a sentence. */
function describeView(v) {
  const frame = v.manifest.timed ? `${v.binOfAll(state.bin)}, ${v.timeOfBin(state.bin)}` : v.binOfAll(state.bin);
  return {
    frame: `Frame at ${frame}`,
    steady: "Steady image, light of all times",
    xt: `Streak of row ${v.row(state.y)}: columns across, time downwards`,
    yt: `Streak of column ${v.column(state.x)}: time across, rows downwards`,
    arrival: "Time at which light arrives",
    mean: "Mean time of arrival",
    peak: "Time of the brightest bin",
    error: `Error of the frame at ${frame}, ${METRICS[state.metric].label}`,
    "steady-error": `Error of the steady image, ${METRICS[state.metric].label}`,
    before: "Light that arrived before the window",
    after: "Light that arrived after the window",
  }[state.view];
}
