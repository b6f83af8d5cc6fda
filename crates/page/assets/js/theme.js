// Dark or light: the system's choice, unless the page's button says otherwise.

/** Whether the page is dark now. */
function isDark() {
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}

/** The other theme from now on; its name. */
function flipTheme() {
  return (document.documentElement.dataset.theme = isDark() ? "light" : "dark");
}
