// The help on keys. Controls that use a key themselves (fields, sliders, lists, buttons) keep it.

/** Whether the focused control wants a key for itself. */
function ownKey(target, key) {
  if (byId("help").open) return key !== "?";
  const kind = target.tagName === "INPUT" ? target.type : target.tagName;
  if (kind === "SELECT") return true;
  if (kind === "text" || kind === "search") return key !== "Escape";
  if (kind === "BUTTON" || kind === "checkbox") return key === " " || key === "Enter";
  const moves = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Home", "End", "PageUp", "PageDown"];
  return kind === "range" && moves.includes(key);
}

/** Shows texts such as "x: what it does" as the help's list. */
function listKeys(texts) {
  byId("help-keys").replaceChildren(...texts.flatMap((text) => {
    const [keys, what] = text.split(/: (.*)/);
    return [element("dt", { text: keys }), element("dd", { text: what })];
  }));
}

function toggleHelp() {
  const help = byId("help");
  if (help.open) help.close();
  else help.showModal();
}
