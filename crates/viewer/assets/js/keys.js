// Keys.

/** What keys do: [keys, what for the help, action(v, event)]. */
const KEYS = [
  [["1", "2", "3", "4", "5", "6", "7", "8", "9"], "1 … 9: show a method", (v, e) => showMethod(v, Number(e.key) - 1)],
  [["r"], "r: to the reference and back", (v) => flipReference(v)],
  [[" "], "space: play, pause", (v) => setPlaying(v, !state.playing)],
  [["ArrowLeft", ","], "←, comma: one bin back", (v) => goTo(v, state.bin - 1)],
  [["ArrowRight", "."], "→, full stop: one bin forth", (v) => goTo(v, state.bin + 1)],
  [["PageUp"], "page up: ten bins back", (v) => goTo(v, state.bin - 10)],
  [["PageDown"], "page down: ten bins forth", (v) => goTo(v, state.bin + 10)],
  [["Home"], "home: first bin", (v) => goTo(v, 0)],
  [["End"], "end: last bin", (v) => goTo(v, v.bins - 1)],
  [["[", "]"], "[ and ]: slower, faster", (v, e) => changeSpeed(e.key === "]" ? 1 : -1)],
  [["v", "V"], "v, shift v: next, previous view", (v, e) => nextView(v, e.key === "v" ? 1 : -1)],
  [["m"], "m: next error measure", (v) => nextMetric(v)],
  [["+", "=", "-"], "+ and −: zoom", (v, e) => zoomBy(v, e.key === "-" ? 0.5 : 2)],
  [["0"], "0: fit the picture", (v) => setZoom(v, 1, 0, 0)],
  [["e", "E"], "e, shift e: half a stop brighter, darker", (v, e) => expose(e.key === "e" ? 0.5 : -0.5)],
  [["x"], "x: exposure back to 0", () => update({ exposure: 0 })],
  [["f"], "f: exposure follows the frame", () => update({ follow: !state.follow })],
  [["c"], "c: next tone curve", () => nextCurve()],
  [["l"], "l: logarithmic or linear axis", () => update({ logAxis: !state.logAxis })],
  [["z"], "z: chart near the slider's time, or whole", () => update({ chartZoom: !state.chartZoom })],
  [["t"], "t: dark or light", () => toggleTheme()],
  [["?"], "?: this help", () => toggleHelp()],
];

/** What shift and arrows do. */
const MOVES = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Moves the selected cell of the view by one. */
function moveSelection(v, [dx, dy]) {
  const { width, height } = v.view.size(v);
  const cell = v.view.cell(v);
  const within = (value, end) => Math.min(end - 1, Math.max(0, value));
  update({ hover: null, ...v.view.place(v, within(cell.x + dx, width), within(cell.y + dy, height)) });
}

function listenToKeys(v) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || ownKey(event.target, event.key)) return;
    const move = event.shiftKey ? MOVES[event.key] : undefined;
    const known = KEYS.find(([keys]) => keys.includes(event.key));
    if (!move && !known) return;
    event.preventDefault();
    if (move) moveSelection(v, move);
    else known[2](v, event);
    announce(v);
  });
}

/** Says what a key has changed, for those who listen. */
function announce(v) {
  settled().then(() => {
    if (!state.playing) byId("live").textContent = stage.canvas.getAttribute("aria-label");
  });
}
