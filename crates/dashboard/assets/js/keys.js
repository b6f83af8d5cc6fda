// Keys: [keys, what for the help, action(data, event)].

/** The next option of a list. */
function nextOption(id) {
  const select = byId(id);
  return select.options.length ? select.options[(select.selectedIndex + 1) % select.options.length].value : undefined;
}

const onTab = (tab, act) => (data, event) => state.tab === tab && act(data, event);
const hasErrors = (data) => data.error_time.scenes.length > 0;

const KEYS = [
  [["1", "2", "3", "4"], "1 … 4: the parts of the dashboard", (data, event) => showTab(TABS[Number(event.key) - 1].name)],
  [["/"], "/: find experiments or benchmarks", () => (state.tab === "benchmarks" ? byId("find-bench") : (showTab("overview"), byId("find"))).focus()],
  [["Escape"], "escape: forget the search and close what is open", () => clearSearch()],
  [["j", "k"], "j, k: next, previous experiment; enter opens it", onTab("overview", (data, event) => stepExperiment(event.key === "j" ? 1 : -1))],
  [["f"], "f: next verdict", onTab("overview", () => update({ verdict: nextOption("verdict") }))],
  [["s"], "s: next scene", onTab("errors", (data) => nextScene(data))],
  [["m"], "m: next measure", onTab("errors", (data) => hasErrors(data) && update({ metric: nextOption("metric"), atError: null }))],
  [["c"], "c: CPU or wall time", onTab("errors", (data) => hasErrors(data) && update({ clock: nextOption("clock"), atTime: null }))],
  [["b"], "b: factors over the next method", onTab("errors", (data) => hasErrors(data) && update({ base: nextOption("base"), atError: null }))],
  [["t"], "t: dark or light", () => toggleTheme()],
  [["?"], "?: this help", () => toggleHelp()],
];

/** Arrow keys on the chart of errors. */
const POINT_MOVES = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

function nextScene(data) {
  const names = data.error_time.scenes.map((scene) => scene.scene);
  if (names.length === 0) return;
  const at = names.indexOf(shownScene(data).scene.scene);
  showScene(names[(at + 1) % names.length]);
}

function clearSearch() {
  for (const id of ["find", "find-bench"]) byId(id).value = "";
  document.activeElement?.blur();
  update({ find: "", findBench: "", verdict: "all", open: "" });
}

const toggleTheme = () => update({ theme: flipTheme() });

function listenToKeys(data) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || ownKey(event.target, event.key)) return;
    if (event.target.getAttribute?.("role") === "tab" && ["ArrowLeft", "ArrowRight"].includes(event.key)) return stepTab(event);
    const move = event.target === byId("error-chart") ? POINT_MOVES[event.key] : undefined;
    const known = KEYS.find(([keys]) => keys.includes(event.key));
    if (!move && !known) return;
    event.preventDefault();
    if (move) stepPoint(data, ...move);
    else known[2](data, event);
  });
}

/** Arrow keys go from tab to tab. */
function stepTab(event) {
  event.preventDefault();
  const at = TABS.findIndex((tab) => tab.name === state.tab);
  const next = TABS[(at + (event.key === "ArrowRight" ? 1 : TABS.length - 1)) % TABS.length].name;
  showTab(next);
  settled().then(() => byId(`tab-${next}`).focus());
}
