// Commands to be repeated.

/** A command with a button that copies it. */
function commandBox(command) {
  const text = element("code", { text: command });
  const copy = element("button", { type: "button", text: "Copy" });
  copy.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(command);
      copy.textContent = "Copied";
    } catch {
      getSelection().selectAllChildren(text);
      copy.textContent = "Selected";
    }
  });
  const box = element("pre", { tabindex: "0" }, [text]);
  return element("div", { className: "command" }, [box, copy]);
}
