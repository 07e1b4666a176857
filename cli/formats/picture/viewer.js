// What is selected, the panel, and what the mouse and the keys do.
const camera = new Camera(report.up);
const state = { selected: -1, component: -1, pending: false };
const DOTS = " Dots are findings: red for errors, orange for warnings, blue for notes.";
let picture = null;

const finding = () => report.findings[state.selected];
const isOn = (id) => element(id).checked && !element(id).disabled;

// Whether the slider has moved A so far that the overlap is gone.
const hasEnded = (now) => Boolean(now && now.mtv && now.ends) && +element("slider").value === 1;

function show() {
  if (state.pending || !picture) return;
  state.pending = true;
  requestAnimationFrame(() => { state.pending = false; paint(); });
}

function paint() {
  const dark = document.documentElement.dataset.theme === "dark", { renderer } = picture, { canvas } = renderer;
  const aspect = canvas.clientWidth / Math.max(1, canvas.clientHeight), now = finding();
  renderer.begin(dark ? [0.08, 0.09, 0.11] : [0.96, 0.965, 0.97], camera.matrix(aspect), camera.eye);
  const step = camera.pixel(Math.max(1, canvas.clientHeight));
  const labels = picture.paint(now, {
    rung: element("rung").value,
    move: now && now.mtv ? times(now.mtv, +element("slider").value) : [0, 0, 0],
    up: camera.world([0, 0, 1]),
    ink: dark ? [1, 1, 1] : [0, 0, 0],
    nearby: [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]].map(([x, y]) => plus(times(camera.side, x * step), times(camera.up, y * step))),
    ended: hasEnded(now),
    component: now && now.components[state.component],
    ...Object.fromEntries(["others", "axis", "ball", "witness"].map((id) => [id, isOn(id)])),
  });
  element("labels").replaceChildren();
  if (element("names").checked) write(labels, aspect);
}

// Each label beside its point, and below those that are in its way.
function write(labels, aspect) {
  const place = element("labels"), taken = [];
  for (const [text, point, kind] of labels) {
    const at = camera.seen(point, aspect);
    if (!at) continue;
    const label = added(place, "span", text);
    label.dataset.kind = kind;
    const { offsetWidth: width, offsetHeight: height } = label, free = place.clientWidth - width;
    const left = Math.max(0, Math.min(free, at[0] * place.clientWidth + 12));
    let top = Math.max(0, Math.min(place.clientHeight - height, at[1] * place.clientHeight - 1.4 * height));
    const meets = (other) => left < other.right && other.left < left + width && top < other.bottom && other.top < top + height;
    for (let other; (other = taken.find(meets)); ) top = other.bottom + 1;
    taken.push({ left, top, right: left + width, bottom: top + height });
    Object.assign(label.style, { left: `${left}px`, top: `${top}px` });
  }
}

// -1: all bodies.
function select(number) {
  const now = report.findings[number];
  Object.assign(state, { selected: now ? number : -1, component: -1 });
  mark(number);
  element("pair").hidden = !now;
  element("detail").textContent = now ? now.text : `All bodies.${report.findings.length ? DOTS : ""}`;
  element("view").setAttribute("aria-label", now ? `3-D view of ${now.names[0]} and ${now.names[1]}` : "3-D view of all bodies");
  listComponents(now, choose);
  if (!picture) return;
  picture.choose(number);
  if (now) offer(now);
  showMoment();
  frame();
}

function showMoment() {
  element("moment").value = picture.moment;
  element("when").textContent = report.moments[picture.moment] || "";
}

function stand(moment) {
  if (!(moment in report.moments)) return;
  picture.stand(moment, finding());
  showMoment();
  show();
}

// What there is to show of a finding.
function offer(now) {
  const drawn = isDrawn(now);
  element("pair").hidden = !drawn;
  [element("name-a").textContent, element("name-b").textContent] = now.names;
  element("slider").value = 0;
  element("way").hidden = !now.mtv;
  for (const [id, there] of [["ball", now.ball], ["witness", now.witness && !now.gap], ["axis", now.axis || now.mtv]]) {
    element(id).disabled = !there;
    element(id).parentElement.hidden = !there;
  }
  const parts = element("rung").querySelector("[value=parts]");
  parts.disabled = !drawn || !(now.a in picture.parts || now.b in picture.parts);
  if (parts.disabled && element("rung").value === "parts") element("rung").value = "triangles";
}

function frame() {
  const now = finding(), view = isDrawn(now) ? now.view : report.view;
  if (view) camera.frame(view);
  show();
}

function choose(number) {
  const item = finding() && finding().components[number];
  if (!item) return;
  state.component = number;
  markComponent(number);
  const { clear } = finding().view;
  camera.frame({ target: times(plus(item.low, item.high), 0.5), radius: norm(minus(item.high, item.low)), clear });
  show();
}

function nextComponent() {
  const { length } = finding() ? finding().components : [];
  if (length) choose((state.component + 1) % length);
}

function step(by) {
  const next = neighbour(state.selected, by);
  if (next >= 0) select(next);
}

function goToBody() {
  const [body] = bodiesNamed(element("search").value);
  if (body === undefined || !picture) return;
  select(-1);
  const [target, radius] = picture.sphereAround([body]);
  camera.frame({ target, radius });
  show();
}

function drag(event) {
  if (!event.buttons) return;
  const height = picture.renderer.canvas.clientHeight;
  if (event.shiftKey || event.buttons === 4) camera.shift(event.movementX / height, event.movementY / height);
  else camera.turn(event.movementX * 0.008, event.movementY * 0.008);
  show();
}

function zoom(by) {
  camera.far *= Math.exp(by);
  show();
}

function toggle(id) {
  if (element(id).disabled) return;
  element(id).checked = !element(id).checked;
  show();
}

function see(rung) {
  const now = element("rung"), option = now.querySelector(`[value=${rung}]`);
  if (option.disabled) return;
  now.value = now.value === rung ? "triangles" : rung;
  show();
}

function setUp(upwards) {
  camera.upwards = element("up").value = upwards;
  show();
}

function turn(x, y) {
  camera.turn(x, y);
  show();
}

const ACTIONS = {
  ArrowDown: () => step(1),
  ArrowUp: () => step(-1),
  Home: () => step(-Infinity),
  End: () => step(Infinity),
  Escape: () => select(-1),
  a: () => select(-1),
  t: () => see("triangles"),
  p: () => see("parts"),
  h: () => see("hulls"),
  b: () => see("boxes"),
  c: nextComponent,
  o: () => toggle("others"),
  x: () => toggle("axis"),
  i: () => toggle("ball"),
  w: () => toggle("witness"),
  l: () => toggle("names"),
  ",": () => stand(picture.moment - 1),
  ".": () => stand(picture.moment + 1),
  f: () => frame(),
  u: () => setUp(camera.upwards === "y" ? "z" : "y"),
  "+": () => zoom(-0.2),
  "-": () => zoom(0.2),
  "/": () => element("search").focus(),
  " ": () => { element("slider").value = +element("slider").value ? 0 : 1; show(); },
};
const ON_THE_VIEW = {
  ArrowLeft: () => turn(-0.1, 0),
  ArrowRight: () => turn(0.1, 0),
  ArrowUp: () => turn(0, 0.1),
  ArrowDown: () => turn(0, -0.1),
};

function key(event) {
  const { id, tagName } = event.target;
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (id === "search") return event.key === "Enter" ? goToBody() : undefined;
  if (tagName === "SELECT" || (/^(slider|moment)$/.test(id) && /^(Arrow|Home|End)/.test(event.key))) return;
  if (event.key === " " && /^(BUTTON|SUMMARY)$/.test(tagName)) return;
  if (event.key === " " && tagName === "INPUT" && id !== "slider") return;
  const action = (id === "view" && ON_THE_VIEW[event.key]) || (picture && ACTIONS[event.key]);
  if (action) { event.preventDefault(); action(); }
}

function setTheme(dark) {
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  show();
}

function say(text) {
  element("problem").textContent = text;
  element("problem").hidden = false;
}

function listen() {
  const { canvas } = picture.renderer;
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", drag);
  canvas.addEventListener("wheel", (event) => { event.preventDefault(); zoom(event.deltaY * 0.001); }, { passive: false });
  for (const id of ["slider", "rung", "others", "axis", "ball", "witness", "names"]) element(id).addEventListener("input", show);
  element("frame").addEventListener("click", frame);
  element("up").value = report.up;
  element("up").addEventListener("input", () => setUp(element("up").value));
  element("all").addEventListener("click", () => select(-1));
  element("moment").addEventListener("input", () => stand(+element("moment").value));
  addEventListener("resize", show);
}

async function start() {
  report.findings = JSON.parse(await unpackedText(report.findings));
  element("title").textContent = document.title = report.title;
  element("verdict").textContent = element("verdict").className = report.verdict;
  element("summary").textContent = report.summary;
  element("time").hidden = report.moments.length < 2;
  element("moment").max = report.moments.length - 1;
  new Set(report.findings.map((each) => each.moment)).forEach((moment) => added(element("impacts"), "option", "", { value: moment }));
  element("simplified").textContent = report.simplified;
  const preferred = matchMedia("(prefers-color-scheme: dark)");
  setTheme(preferred.matches);
  preferred.addEventListener("change", (event) => setTheme(event.matches));
  element("theme").addEventListener("click", () => setTheme(document.documentElement.dataset.theme !== "dark"));
  element("search").addEventListener("input", search);
  addEventListener("keydown", key);
  list(select);
  select(report.findings.length && !report.all ? 0 : -1);
  if (!report.drawn) say("There is no picture: the coordinates are too large for it.");
  try {
    const loading = new Picture(new Renderer(element("view")));
    await loading.load();
    picture = loading;
    listen();
    if (report.findings.some((each) => each.parts.flat().length)) element("rung").value = "parts";  // they were asked for
    select(state.selected);
  } catch (error) {
    say(`${error.message} The list of findings is complete without the picture.`);
  }
  document.body.dataset.ready = "true";
}

start();
