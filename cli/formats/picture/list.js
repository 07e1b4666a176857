// The list of findings, the list of components, and the search.
const element = (id) => document.getElementById(id);
const itemOf = (number) => element(`finding-${number}`);

function added(parent, kind, text, more = {}) {
  const made = Object.assign(document.createElement(kind), more);
  made.textContent = text; // never markup
  parent.append(made);
  return made;
}

function list(choose) {
  report.findings.forEach((each, number) => {
    const item = added(element("findings"), "li", "", { id: `finding-${number}` });
    Object.assign(item.dataset, { number, severity: each.severity });
    item.setAttribute("role", "option");
    item.setAttribute("aria-selected", "false");
    added(item, "div", `${each.names[0]} and ${each.names[1]}`);
    added(item, "small", `${each.severity}: ${each.measured}`);
    item.addEventListener("click", () => choose(number));
  });
  report.issues.forEach((text) => added(element("issues"), "li", text));
  element("issues-count").textContent = report.counted;
  Object.assign(element("warnings"), { hidden: !report.issues.length, open: /\berrors?\b/.test(report.counted) });
  count();
}

function mark(number) {
  for (const item of element("findings").querySelectorAll("[aria-selected=true]"))
    item.setAttribute("aria-selected", "false");
  const item = itemOf(number);
  if (!item) return element("findings").removeAttribute("aria-activedescendant");
  item.setAttribute("aria-selected", "true");
  item.scrollIntoView({ block: "nearest" });
  element("findings").setAttribute("aria-activedescendant", item.id);
}

// The finding that many places further down among those that the search leaves.
function neighbour(selected, by) {
  const items = [...element("findings").children].filter((item) => !item.hidden);
  const at = items.findIndex((item) => +item.dataset.number === selected);
  const next = items[Math.min(items.length - 1, Math.max(0, at + by))];
  return next ? +next.dataset.number : -1;
}

function search() {
  const wanted = element("search").value.toLowerCase();
  for (const item of element("findings").children)
    item.hidden = !report.findings[+item.dataset.number].text.toLowerCase().includes(wanted);
  count();
}

// Bodies without findings are found too: enter goes to the first.
const bodiesNamed = (text) =>
  report.bodies.ids.flatMap((id, body) => (id.toLowerCase().includes(text.toLowerCase()) ? [body] : []));

function count() {
  const all = report.findings.length, left = [...element("findings").children].filter((item) => !item.hidden).length;
  const text = element("search").value, bodies = text ? bodiesNamed(text).length : report.bodies.ids.length;
  const findings = `${text ? `${left} of ` : ""}${all} finding${all === 1 ? "" : "s"}`;
  const unlisted = report.unlisted ? ` (${report.unlisted.toLocaleString("en")} less severe ones are not listed)` : "";
  element("count").textContent = `${findings}${unlisted}, ${bodies} ${bodies === 1 ? "body" : "bodies"}`;
}

function listComponents(now, choose) {
  const place = element("components");
  place.replaceChildren();
  element("places").hidden = !now || now.components.length === 0;
  if (!now) return;
  now.components.forEach((item, number) => {
    const button = added(added(place, "li", ""), "button", item.text, { type: "button" });
    button.setAttribute("aria-pressed", "false");
    button.addEventListener("click", () => choose(number));
  });
  if (now.more) added(place, "li", `${now.more} more: a JSON report has all`);
}

function markComponent(number) {
  [...element("components").querySelectorAll("button")].forEach((button, k) => {
    button.setAttribute("aria-pressed", String(k === number));
    if (k === number) button.scrollIntoView({ block: "nearest" });
  });
}
