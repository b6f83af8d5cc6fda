// Buttons, sliders and lists: they change the state, and follow it.

function fillSelect(id, entries, key) {
  const select = byId(id);
  select.replaceChildren(...entries.map(([value, text]) => element("option", { value, text })));
  select.addEventListener("change", () => {
    const value = select.value;
    update({ [key]: typeof state[key] === "number" ? Number(value) : value });
  });
}

/** Buttons of a group, of which one is pressed. */
function buttonGroup(id, entries, choose) {
  byId(id).replaceChildren(...entries.map(({ text, hint, mark, title }, index) => {
    const button = element("button", { type: "button", "aria-pressed": "false" }, [
      ...(mark ? [mark] : []), document.createTextNode(text), ...(hint ? [element("kbd", { text: hint })] : []),
    ]);
    if (title) button.title = title;
    button.addEventListener("click", () => choose(index));
    return button;
  }));
}

function pressOnly(id, chosen) {
  [...byId(id).children].forEach((button, index) => {
    const pressed = index === chosen;
    button.setAttribute("aria-pressed", String(pressed));
    if (pressed && byId(id).scrollWidth > byId(id).clientWidth) {
      byId(id).scrollLeft = button.offsetLeft - byId(id).offsetLeft - 24;
    }
  });
}

function buildControls(v) {
  const { manifest } = v;
  byId("caption").textContent = manifest.caption;
  buttonGroup("methods", v.cubes.map((cube, index) => ({
    text: cube.entry.label, hint: index < 9 ? String(index + 1) : "", mark: swatch(cube),
  })), (index) => showMethod(v, index));
  buttonGroup("views", v.views.map((view) => ({ text: view.label, title: view.hint })), (index) => update({ view: v.views[index].name, hover: null }));
  fillSelect("speed", SPEEDS.map((speed) => [String(speed), `${speed} bins/s`]), "speed");
  fillSelect("channel", v.channels === 3 ? [["luminance", "luminance"], ["0", "red"], ["1", "green"], ["2", "blue"]] : [["luminance", "value"]], "channel");
  fillSelect("curve", Object.keys(CURVES).map((name) => [name, name]), "curve");
  const judges = v.reference && v.cubes.length > 1;
  fillSelect("chart-kind", Object.entries(CHART_KINDS).filter(([, kind]) => !kind.judges || judges).map(([name, kind]) => [name, kind.label]), "chartKind");
  const metrics = Object.entries(METRICS).filter(([name]) => name !== "z" || v.cubes.some((cube) => cube !== v.reference && cube.hasErrors && cube.entry.independent));
  fillSelect("metric", metrics.map(([name, metric]) => [name, metric.label]), "metric");
  for (const node of document.querySelectorAll(".needs-reference")) node.hidden = !judges;
  byId("channel").hidden = v.channels !== 3;
  byId("transport").hidden = v.bins === 0;
  byId("chart-card").hidden = v.bins === 0;
  const time = byId("time");
  time.max = String(Math.max(0, v.bins - 1));
  time.addEventListener("input", () => goTo(v, Number(time.value)));
  byId("play").addEventListener("click", () => setPlaying(v, !state.playing));
  byId("back").addEventListener("click", () => goTo(v, state.bin - 1));
  byId("forth").addEventListener("click", () => goTo(v, state.bin + 1));
  byId("exposure").addEventListener("input", (event) => update({ exposure: Number(event.target.value) }));
  byId("follow").addEventListener("change", (event) => update({ follow: event.target.checked }));
  byId("log-axis").addEventListener("change", (event) => update({ logAxis: event.target.checked }));
  byId("chart-zoom").addEventListener("change", (event) => update({ chartZoom: event.target.checked }));
  byId("theme").addEventListener("click", toggleTheme);
  byId("help-open").addEventListener("click", toggleHelp);
  byId("help-close").addEventListener("click", toggleHelp);
  listKeys([...KEYS.map((key) => key[1]), "shift and arrows: move the selected pixel"]);
}

/** Makes the controls show the state. */
function syncControls(v) {
  pressOnly("methods", state.method);
  pressOnly("views", v.views.indexOf(v.view));
  const time = byId("time");
  time.value = String(state.bin);
  if (v.bins > 0) {
    const bin = v.binOfAll(state.bin);
    time.setAttribute("aria-valuetext", v.manifest.timed ? `${bin}, ${v.timeOfBin(state.bin)}` : bin);
    const parts = v.manifest.timed ? [`${v.timeOfBin(state.bin)} · `] : [];
    byId("time-text").replaceChildren(...parts, element("span", { text: bin }));
  }
  byId("play").textContent = state.playing ? "Pause" : "Play";
  byId("exposure").value = String(state.exposure);
  byId("exposure-text").textContent = `${state.exposure > 0 ? "+" : ""}${String(state.exposure).replace("-", "−")} EV`;
  byId("follow").checked = state.follow;
  byId("log-axis").checked = isLog();
  byId("chart-zoom").checked = state.chartZoom;
  byId("log-axis").disabled = !CHART_KINDS[state.chartKind].log;
  for (const [id, key] of [["speed", "speed"], ["channel", "channel"], ["curve", "curve"], ["chart-kind", "chartKind"], ["metric", "metric"]]) {
    byId(id).value = String(state[key]);
  }
  byId("display-note").textContent = v.view.colour
    ? `0 EV: ${state.follow && v.view.name === "frame" ? "99 % of this frame's lit pixels" : "nearly all lit cells"} of ${v.leader.entry.label} are below white; the same for all methods. Curve ${state.curve}: ${CURVES[state.curve].label}; then sRGB.`
    : v.view.judges ? `ε = ${v.view.name === "error" ? v.withUnit(digits(cubeEpsilon(v)), v.unit) : v.withUnit(digits(steadyEpsilon(v)), v.imageUnit)}: 1 % of the mean of the reference's lit ${v.view.name === "error" ? "cells" : "pixels"}. Of luminance.` : "Pixels without light are black.";
}

/** Shows a method, if there is one of that number. */
function showMethod(v, index) {
  if (index < v.cubes.length) update({ method: index });
}

/** To the reference, and back to the method shown before. */
function flipReference(v) {
  if (!v.reference) return;
  const reference = v.reference.index;
  if (state.method === reference) update({ method: v.beforeReference ?? (reference === 0 ? Math.min(1, v.cubes.length - 1) : 0) });
  else {
    v.beforeReference = state.method;
    update({ method: reference });
  }
}

function nextView(v, step) {
  const count = v.views.length;
  update({ view: v.views[(v.views.indexOf(v.view) + step + count) % count].name, hover: null });
}

/** The next entry of a list that is offered. */
function nextOf(id, key) {
  const select = byId(id);
  update({ [key]: select.options[(select.selectedIndex + 1) % select.options.length].value });
}

const nextMetric = (v) => v.reference && nextOf("metric", "metric");
const nextCurve = () => nextOf("curve", "curve");
const expose = (stops) => update({ exposure: Math.min(12, Math.max(-12, state.exposure + stops)) });

const toggleTheme = () => update({ theme: flipTheme() });
