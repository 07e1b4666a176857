// The list of findings, the panel, and what the mouse and the keys do.
const report = JSON.parse(document.getElementById("data").textContent);
const element = (id) => document.getElementById(id);
const A = [0.16, 0.44, 0.84], B = [0.9, 0.55, 0.1], OTHER = [0.5, 0.54, 0.6], RED = [0.86, 0.1, 0.12];
const camera = new Camera();
let renderer, shapes = [], hulls = [], lines = [], arrow = null, selected = -1, pending = false;

const finding = () => report.findings[selected];
// A body without geometry has no number.
const isDrawn = (now) => Boolean(now) && now.a !== null && now.b !== null;
const centre = (g) => g.low.map((v, k) => v + g.size[k] / 2);

function sphereAround(bodies) {
  const low = [0, 1, 2].map((k) => Math.min(...bodies.map((g) => g.low[k])));
  const high = [0, 1, 2].map((k) => Math.max(...bodies.map((g) => g.low[k] + g.size[k])));
  return [times(plus(low, high), 0.5), norm(minus(high, low)) / 2];
}

function show() {
  if (pending || !renderer) return;
  pending = true;
  requestAnimationFrame(() => { pending = false; paint(); });
}

function paint() {
  const dark = document.documentElement.dataset.theme === "dark";
  const canvas = renderer.canvas, gl = renderer.gl;
  const aspect = canvas.clientWidth / Math.max(1, canvas.clientHeight);
  renderer.begin(dark ? [0.08, 0.09, 0.11] : [0.96, 0.965, 0.97], camera.matrix(aspect), camera.eye);
  const now = finding();
  if (!isDrawn(now)) {
    shapes.forEach((shape) => renderer.draw(shape, [...OTHER, 1]));
    return;
  }
  const pick = element("hulls").checked ? (n) => hulls[n] || shapes[n] : (n) => shapes[n];
  const move = now.mtv ? times(now.mtv, +element("slider").value) : [0, 0, 0];
  if (element("others").checked)
    shapes.forEach((shape, n) => {
      if (n !== now.a && n !== now.b) renderer.translucent(shape, [...OTHER, 0.08]);
    });
  renderer.translucent(pick(now.a), [...A, 0.4], move);
  renderer.translucent(pick(now.b), [...B, 0.4]);
  renderer.overlap(pick(now.a), move, pick(now.b), [0, 0, 0], [...RED, 0.85]);
  renderer.overlap(pick(now.b), [0, 0, 0], pick(now.a), move, [...RED, 0.85]);
  gl.disable(gl.DEPTH_TEST);
  lines.forEach((line) => renderer.draw(line, [...RED, 1], [0, 0, 0], gl.LINE_STRIP, 0));
  if (arrow) renderer.draw(arrow, dark ? [1, 1, 1, 1] : [0, 0, 0, 1], [0, 0, 0], gl.LINES, 0);
}

// A line with a head, from where the bodies overlap along the way out, and long enough to be seen.
function arrowOf(now) {
  if (!now.mtv || !norm(now.mtv)) return null;
  const from = now.witness ? now.witness[0] : now.curves.length ? now.curves[0][0] : centre(report.bodies[now.a]);
  const to = plus(from, now.mtv), back = times(now.mtv, -0.25);
  const across = Math.abs(now.mtv[2]) < 0.9 * norm(now.mtv) ? [0, 0, 1] : [1, 0, 0];
  const side = cross(now.mtv, across), wing = times(side, (0.12 * norm(now.mtv)) / norm(side));
  const head = plus(to, back);
  return renderer.lines([from, to, to, plus(head, wing), to, minus(head, wing)]);
}

function select(number) {
  selected = number;
  const now = finding();
  for (const item of element("findings").children) {
    const chosen = +item.dataset.number === number;
    item.setAttribute("aria-selected", chosen);
    if (chosen) item.scrollIntoView({ block: "nearest" });
  }
  element("panel").hidden = !now;
  if (!now) return show();
  element("detail").textContent = now.text;
  element("way").hidden = !now.mtv || !isDrawn(now);
  if (!isDrawn(now)) return show();
  element("slider").value = 0;
  lines = now.curves.map((curve) => renderer.lines([...curve, curve[0]]));
  arrow = arrowOf(now);
  frame();
}

function frame() {
  const now = finding(), pair = isDrawn(now) ? [report.bodies[now.a], report.bodies[now.b]] : report.bodies;
  if (pair.length) {
    const [target, radius] = sphereAround(pair);
    const smaller = isDrawn(now) ? Math.min(...pair.map((g) => norm(g.size))) : 2 * radius;
    const least = pair.find((g) => norm(g.size) === smaller);
    // Beside a large body the small one says where to look.
    if (isDrawn(now) && smaller < radius / 2) camera.frame(centre(least), smaller);
    else camera.frame(target, radius);
  }
  show();
}

function step(by) {
  const items = [...element("findings").children].filter((item) => !item.hidden);
  const at = items.findIndex((item) => +item.dataset.number === selected);
  const next = items[Math.min(items.length - 1, Math.max(0, at + by))];
  if (next) select(+next.dataset.number);
}

function list() {
  report.findings.forEach((each, number) => {
    const item = document.createElement("li");
    item.dataset.number = number;
    item.dataset.severity = each.severity;
    item.setAttribute("role", "option");
    const names = document.createElement("div"), words = document.createElement("small");
    names.textContent = each.names;
    words.textContent = `${each.severity}: ${each.relation}`;
    item.append(names, words);
    item.addEventListener("click", () => select(number));
    element("findings").append(item);
  });
  report.issues.forEach((text) => {
    const item = document.createElement("li");
    item.textContent = text;
    element("issues").append(item);
  });
}

function search() {
  const wanted = element("search").value.toLowerCase();
  for (const item of element("findings").children)
    item.hidden = !report.findings[+item.dataset.number].text.toLowerCase().includes(wanted);
}

function drag(event) {
  if (!event.buttons) return;
  const scale = camera.far / renderer.canvas.clientHeight;
  if (event.shiftKey || event.buttons === 4) {
    const shift = plus(times(camera.side, -event.movementX * scale), times(camera.up, event.movementY * scale));
    camera.target = plus(camera.target, shift);
  } else {
    camera.yaw -= event.movementX * 0.008;
    camera.pitch = Math.max(-1.55, Math.min(1.55, camera.pitch + event.movementY * 0.008));
  }
  show();
}

function toggle(id) {
  element(id).checked = !element(id).checked;
  show();
}

function key(event) {
  if (event.target.id === "search") return;
  const actions = {
    ArrowDown: () => step(1),
    ArrowUp: () => step(-1),
    h: () => toggle("hulls"),
    o: () => toggle("others"),
    f: frame,
    " ": () => { element("slider").value = +element("slider").value ? 0 : 1; show(); },
  };
  if (event.target.id === "slider" && event.key.startsWith("Arrow")) return;
  if (actions[event.key]) { event.preventDefault(); actions[event.key](); }
}

function setTheme(dark) {
  document.documentElement.dataset.theme = dark ? "dark" : "light";
  show();
}

async function start() {
  element("title").textContent = report.title;
  const preferred = matchMedia("(prefers-color-scheme: dark)");
  setTheme(preferred.matches);
  preferred.addEventListener("change", (event) => setTheme(event.matches));
  list();
  if (!report.drawn) {
    element("problem").textContent = "There is no picture: the coordinates are too large for it.";
    element("problem").hidden = false;
  }
  try {
    renderer = new Renderer(element("view"));
  } catch (error) {
    element("problem").textContent = `${error.message} The list of findings is complete without the picture.`;
    element("problem").hidden = false;
    return;
  }
  const meshes = await Promise.all(report.meshes.map((mesh) => renderer.mesh(mesh)));
  shapes = report.bodies.map((body) => renderer.placed(meshes[body.mesh], body.frame));
  hulls = report.bodies.map((body) => body.hull && renderer.placed(meshes[body.hull.mesh], body.hull.frame));
  const canvas = renderer.canvas;
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", drag);
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.far *= Math.exp(event.deltaY * 0.001);
    show();
  }, { passive: false });
  for (const id of ["slider", "hulls", "others"]) element(id).addEventListener("input", show);
  element("frame").addEventListener("click", frame);
  element("theme").addEventListener("click", () => setTheme(document.documentElement.dataset.theme !== "dark"));
  element("search").addEventListener("input", search);
  addEventListener("keydown", key);
  addEventListener("resize", show);
  select(report.findings.length ? 0 : -1);
  if (selected < 0) frame();
  document.body.dataset.ready = "true";
}

start();
