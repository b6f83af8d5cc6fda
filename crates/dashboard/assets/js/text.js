// Times, intervals and verdicts in words.

/** Commands that make what may be missing. */
const COMMANDS = {
  validate: "cargo xtask validate --quick",
  errors: "cargo xtask error-time",
  bench: "cargo xtask bench && cargo xtask dashboard",
};

const VERDICTS = {
  passed: { word: "passed", mark: "✓", tone: "good" },
  failed: { word: "failed", mark: "✗", tone: "bad" },
  broken: { word: "broken", mark: "!", tone: "odd" },
  missing: { word: "not run", mark: "·", tone: "none" },
  retired: { word: "retired", mark: "–", tone: "none" },
};

const padded = (number) => String(number).padStart(2, "0");

/** Seconds since 1970 as local date and time. */
function when(time) {
  const d = new Date(1000 * time);
  return `${d.getFullYear()}-${padded(d.getMonth() + 1)}-${padded(d.getDate())} ${padded(d.getHours())}:${padded(d.getMinutes())}`;
}

/** A commit as short as names of commits are. */
const shortCommit = (commit) => commit.replace(/^([0-9a-f]{8})[0-9a-f]+/, "$1");

function duration(seconds) {
  if (seconds === null || seconds === undefined) return "–";
  if (seconds < 0.1) return "< 0.1 s";
  if (seconds < 100) return `${seconds.toFixed(1)} s`;
  return `${Math.floor(seconds / 60)} min ${Math.round(seconds % 60)} s`;
}

/** A relative error with its sign. */
function signedPercent(value) {
  if (value === null) return "∞";
  const size = Math.abs(100 * value);
  const text = size >= 1e5 ? digits(size, 2) : size.toFixed(size >= 100 ? 0 : 2);
  return `${value < 0 ? "−" : "+"}${text} %`;
}

/** An interval of relative errors. */
function intervalText(interval) {
  if (!interval) return "–";
  const size = Math.max(...interval.map((end) => (end === null ? Infinity : Math.abs(end))));
  if (size < 1e-4) return `within ±${digits(size, 2)}`;
  return `${signedPercent(interval[0])} … ${signedPercent(interval[1])}`;
}

const pText = (p) => (p === null || p === undefined ? "–" : p >= 0.001 ? p.toFixed(3) : digits(p, 2));

/** The mark and the word of a verdict. */
function verdictBadge(verdict, word) {
  const { mark, tone, word: own } = VERDICTS[verdict];
  return element("span", { className: `verdict ${tone}` }, [
    element("span", { text: `${mark} `, "aria-hidden": "true" }), document.createTextNode(word ?? own),
  ]);
}

/** Terms and what they mean, without those that are empty. */
function terms(entries) {
  return entries.filter(([, value]) => value !== "" && value !== null && value !== undefined)
    .flatMap(([name, value]) => [element("dt", { text: name }), element("dd", { text: String(value) })]);
}

/** What is missing, and the command that makes it. */
function missingCard(text, command) {
  return element("div", { className: "card missing" }, [element("p", { text }), commandBox(command)]);
}

/** A table's head. */
function tableHead(columns) {
  return element("thead", {}, [element("tr", {}, columns.map(([text, number, title]) => element("th", {
    text, scope: "col", ...(number ? { className: "number" } : {}), ...(title ? { title } : {}),
  })))]);
}

const cell = (text, className = "") => element("td", { text, className });

/** Whether a name or text has all words of a search; a word with * or ? is a pattern of the name. */
function matchesSearch(search, name, text) {
  const all = `${name} ${text}`.toLowerCase();
  return search.toLowerCase().split(/\s+/).filter(Boolean).every((word) => {
    if (!/[*?]/.test(word)) return all.includes(word);
    const pattern = word.replace(/[.+^${}()|[\]\\]/g, "\\$&").replace(/\*/g, ".*").replace(/\?/g, ".");
    return new RegExp(`^${pattern}$`).test(name.toLowerCase());
  });
}
