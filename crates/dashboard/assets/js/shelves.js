// Pages of other commands: links to what is there, commands for what is missing.

function pageCard(page) {
  const link = element("a", { href: page.link, text: page.title });
  const picture = page.picture ? [element("img", { src: page.picture, alt: "", loading: "lazy" })] : [];
  const size = page.bytes >= 1e6 ? `${(page.bytes / 1e6).toFixed(1)} MB` : `${Math.ceil(page.bytes / 1e3)} kB`;
  return element("article", { className: "card page-card" }, [
    ...picture, element("h3", {}, [link]), element("p", { className: "note", text: `${size}, ${when(page.time)}` }),
  ]);
}

function drawShelves(data) {
  const shelf = ({ title, command, pages }) => element("section", {}, [
    element("h2", { text: title }),
    ...(pages.length
      ? [element("div", { className: "cards" }, pages.map(pageCard))]
      : [missingCard("There are no such pages yet.", command)]),
  ]);
  byId("shelves").replaceChildren(...data.shelves.map(shelf));
}
