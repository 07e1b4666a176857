// The bodies of the report, and what is drawn of a finding.
const A = [0.16, 0.44, 0.84], B = [0.9, 0.55, 0.1], OTHER = [0.5, 0.54, 0.6], RED = [0.86, 0.1, 0.12];
const YELLOW = [1, 0.85, 0.1], GREEN = [0, 0.6, 0.45], RIM = [0.75, 0.1, 0.65];
// Of bodies with findings: between these, so that neighbours differ.
const MET = [[0.42, 0.52, 0.7], [0.7, 0.77, 0.86]];

const TINTS = { error: [0.82, 0.2, 0.2], warning: [0.8, 0.52, 0.05], note: [0.25, 0.5, 0.75] };
const STILL = [0, 0, 0];
// Which body is all of the overlap.
const INNER = { contains: "b", inside: "a", coincident: "a" };
const NUMBERS = 18; // of a body at a moment: its rows and its box
const CROWD = 100, SURROUNDINGS = 4; // bodies; radii of the pair
const FAINT = report.bodies.ids.length > CROWD ? 0.04 : 0.08;
const hues = (count) => Array.from({ length: count }, (_, k) => {
  const turn = (k * 0.618034) % 1; // golden section: neighbours differ
  return [0, 1 / 3, 2 / 3].map((at) => 0.5 + 0.35 * Math.cos(2 * Math.PI * (turn + at)));
});
const shade = (body) => {
  const share = (body * 0.618034) % 1; // golden section
  return plus(times(MET[0], 1 - share), times(MET[1], share));
};
// A body without geometry has no number.
const isDrawn = (now) => Boolean(now) && now.a !== null && now.b !== null;
// Three digits, and all before the point, as in tables.
const rounded = (value) => (value < 999.5 ? Number(value.toPrecision(3)) : Math.round(value));
const STEPS = 65535; // of a coordinate, from one side of the box of its mesh to the other

// Where a point comes to lie, and rows that first scale and shift.
const placedAt = (rows, at) => [0, 1, 2].map((r) => dot(rows.slice(4 * r, 4 * r + 3), at) + rows[4 * r + 3]);
const within = (rows, { scale, offset }) => {
  const origin = placedAt(rows, offset);
  return [0, 1, 2].flatMap((r) => [...[0, 1, 2].map((k) => rows[4 * r + k] * scale[k]), origin[r]]);
};

class Picture {
  constructor(renderer) {
    Object.assign(this, { renderer, shapes: new Map(), strips: [], dots: [], crowds: [], near: [], shadows: null, moment: 0 });
  }

  async load() {
    const { renderer } = this, { bodies } = report;
    const meshes = await Promise.all(report.meshes.map(unpackedMesh));
    this.meshes = meshes.map((mesh) => renderer.mesh(mesh));
    [this.frames, this.boxes] = await Promise.all(
      [bodies.frames, bodies.boxes].map((text) => unpacked(text, Float32Array)));
    for (const each of report.findings.filter(isDrawn)) each.points = await unpackedPoints(each.points);
    this.parts = report.parts;
    this.moved = {};
    for (const [body, text] of Object.entries(report.moved)) this.moved[body] = await unpacked(text, Float32Array);
    for (const [name, mesh] of Object.entries(report.solids)) this[name] = renderer.mesh(await unpackedMesh(mesh));
    this.tints = bodies.ids.map(() => OTHER);
    for (const each of report.findings)
      for (const body of [each.a, each.b]) if (body !== null) this.tints[body] = shade(body);
    for (const [body, state] of Object.entries(report.states)) this.tints[body] = TINTS[state];
    this.stand(0, null);
  }

  // Bodies stand as they do at a moment. now: the finding that is shown.
  stand(moment, now) {
    const { renderer } = this;
    for (const shape of [...this.crowds, ...this.near, ...this.dots.map((dot) => dot.shape)]) renderer.forget(shape);
    this.moment = moment;
    this.shapes.clear();
    this.shadows = null;
    this.crowds = this.grouped(report.bodies.ids.map((_, body) => body));
    this.near = isDrawn(now) ? this.surroundings(now) : [];
    this.dots = Object.entries(TINTS).flatMap(([severity, colour]) => {
      const places = report.findings.filter((each) => isDrawn(each) && each.severity === severity && each.moment === moment);
      return places.length ? [{ shape: renderer.strip(places.map((each) => each.place)), colour }] : [];
    }).reverse(); // errors last, on top
  }

  // Bodies of one mesh are drawn at once.
  grouped(members) {
    const groups = new Map();
    for (const body of members) {
      const mesh = report.bodies.meshes[body];
      if (!groups.has(mesh)) groups.set(mesh, []);
      groups.get(mesh).push([...this.rows(body), ...this.tints[body], body]);
    }
    return [...groups].map(([mesh, group]) => this.renderer.crowd(this.meshes[mesh], group));
  }

  // Of a large scene only what surrounds the pair.
  surroundings(now) {
    const { ids } = report.bodies;
    if (ids.length <= CROWD) return this.grouped(ids.map((_, body) => body));
    const [centre, radius] = this.sphereAround([now.a, now.b]);
    return this.grouped(ids.flatMap((_, body) => {
      const [low, high] = this.box(body);
      const away = [0, 1, 2].map((k) => Math.max(low[k] - centre[k], centre[k] - high[k], 0));
      return norm(away) < SURROUNDINGS * radius ? [body] : [];
    }));
  }

  rows(body) {
    const moved = this.moved[body], first = moved ? NUMBERS * this.moment : 12 * body;
    return [...(moved || this.frames).subarray(first, first + 12)];
  }

  box(body) {
    const moved = this.moved[body], first = moved ? NUMBERS * this.moment + 12 : 6 * body;
    const corners = [...(moved || this.boxes).subarray(first, first + 6)];
    return [corners.slice(0, 3), corners.slice(3)];
  }

  // What a rung sees of a body; without parts or hull the triangles.
  shape(body, rung) {
    const key = `${rung} ${body}`;
    if (!this.shapes.has(key)) this.shapes.set(key, this.made(body, rung));
    return this.shapes.get(key);
  }

  made(body, rung) {
    const { renderer, meshes } = this, parts = this.parts[body];
    if (rung === "boxes") {
      const [low, high] = this.box(body);
      return renderer.placed(this.cube, boxRows(low, minus(high, low)));
    }
    if (rung === "parts" && parts) {
      const shape = renderer.placed(meshes[parts.mesh], within(this.rows(body), parts));
      let first = 0;
      shape.ranges = parts.triangles.map((count) => [3 * (first += count) - 3 * count, 3 * count]);
      return shape;
    }
    const hull = rung === "hulls" ? report.hulls[body] : undefined;
    return renderer.placed(meshes[hull === undefined ? report.bodies.meshes[body] : hull], this.rows(body));
  }

  sphereAround(bodies) {
    const boxes = bodies.map((body) => this.box(body));
    const low = [0, 1, 2].map((k) => Math.min(...boxes.map(([least]) => least[k])));
    const high = [0, 1, 2].map((k) => Math.max(...boxes.map(([, greatest]) => greatest[k])));
    return [times(plus(low, high), 0.5), norm(minus(high, low)) / 2];
  }

  // Of a finding that is drawn; the strips of the one before are forgotten.
  choose(number) {
    const now = report.findings[number], { renderer } = this;
    for (const { shape } of this.strips) renderer.forget(shape);
    this.strips = [];
    this.stand(isDrawn(now) ? now.moment : this.moment, now);
    if (!isDrawn(now)) return;
    let first = 0;
    now.lines.forEach((count, k) => {
      const points = now.points.slice(3 * first, 3 * (first += count)), isRim = k >= now.lines.length - now.rims;
      const rows = boxRows(now.box[0], minus(now.box[1], now.box[0]));
      this.strip(points, isRim ? RIM : RED, renderer.gl.LINE_STRIP, isRim ? "thick" : "line", rows);
    });
    if (now.gap) this.strip(now.gap, GREEN, renderer.gl.LINES, "thick");
    if (now.hit) this.strip([now.hit], RED, renderer.gl.POINTS, "hit");
    if (now.gap) now.gap.forEach((point, k) => this.strip([point], [A, B][k], renderer.gl.POINTS, "gap"));
    else if (now.witness) {
      this.strip(now.witness, YELLOW, renderer.gl.LINES, "witness");
      this.strip([now.witness[0]], A, renderer.gl.POINTS, "witness");
      this.strip([now.witness[1]], B, renderer.gl.POINTS, "witness");
    }
  }

  strip(points, colour, mode, kind, rows) {
    this.strips.push({ shape: this.renderer.strip(points, rows), colour, mode, kind });
  }

  // view: what the panel says: rung, move, ink, and what to show.
  paint(now, view) {
    const { renderer } = this, gl = renderer.gl, labels = [];
    if (!isDrawn(now)) {
      for (const crowd of this.crowds) renderer.drawCrowd(crowd, [...OTHER, 1], [-1, -1], true);
      renderer.onTop();
      for (const { shape, colour } of this.dots)
        renderer.draw(shape, [...colour, 1], { mode: gl.POINTS, lit: -1 });
      this.answers(view.ink);
      return labels;
    }
    const own = now.moment === this.moment, inner = own && !norm(view.move) && INNER[now.relation];
    if (view.others)
      for (const crowd of this.near) renderer.drawCrowd(crowd, [...OTHER, FAINT], [now.a, now.b], false);
    const [a, b] = [now.a, now.b].map((body) => this.shape(body, view.rung));
    if (inner !== "a") this.body(a, A, view.move, now.parts[0]);
    if (inner !== "b") this.body(b, B, STILL, now.parts[1]);
    if (inner) renderer.translucent(inner === "a" ? a : b, [...RED, 0.85]);
    else if (!own || now.overlaps) {
      renderer.overlap(a, view.move, b, STILL, [...RED, 0.85]);
      renderer.overlap(b, STILL, a, view.move, [...RED, 0.85]);
    }
    renderer.onTop();
    if (own) this.marks(now, view);
    if (own && view.axis) this.axis(now, view, [a, b], labels);
    for (const [text, at, kind] of now.labels) {
      if (kind === "a") labels.push([text, plus(placedAt(this.rows(now.a), at), view.move), kind]);
      else if (kind === "b") labels.push([text, placedAt(this.rows(now.b), at), kind]);
      else if (own && (kind !== "ball" || (view.ball && !view.ended))) labels.push([text, at, kind]);
    }
    return labels;
  }

  // What the figures are about, at the moment for which they hold.
  marks(now, view) {
    const { renderer } = this, gl = renderer.gl;
    for (const { shape, colour, mode, kind } of this.strips) {
      if (kind === "witness" && !view.witness) continue;
      const draw = (move) => renderer.draw(shape, [...colour, 1], { move, mode, lit: mode === gl.POINTS ? -1 : 0 });
      for (const move of kind === "thick" ? view.nearby : [STILL]) draw(move);
    }
    if (view.ball && now.ball && !view.ended)
      renderer.translucent(renderer.placed(this.sphere, ballRows(now.ball.centre, now.ball.radius)), [...YELLOW, 0.8]);
    if (view.component) this.component(view.component, view.ink);
    if (now.from) this.pointer(now.from, now.mtv, this.sphereAround([now.a, now.b])[1], view.ink);
  }

  // overlapping: the numbers of the parts that overlap parts of the other body: reddish among pale ones.
  body(shape, colour, move, overlapping) {
    const { renderer } = this;
    if (!shape.ranges) return renderer.translucent(shape, [...colour, 0.4], { move });
    hues(shape.ranges.length).forEach((hue, k) => {
      const overlaps = overlapping.includes(k + 1), pale = overlapping.length && !overlaps;
      const mixed = plus(times(overlaps ? RED : pale ? colour : hue, 0.6), times(colour, 0.4));
      renderer.translucent(shape, [...mixed, pale ? 0.2 : 0.45], { move, range: shape.ranges[k] });
    });
  }

  rodFrom(from, to, radius, colour, mesh = this.rod) {
    const along = minus(to, from), x = times(across(along), radius), y = cross(unit(along), x);
    const rows = rowsOf(times(x, 2), times(y, 2), along, minus(from, plus(x, y)));
    this.renderer.draw(this.renderer.placed(mesh, rows), [...colour, 1]);
  }

  // radius: of the bodies beside it, which decides how thick the arrow is.
  pointer(from, way, radius, colour) {
    const length = norm(way), head = Math.min(0.4 * length, 0.12 * radius), thick = Math.min(0.1 * length, 0.012 * radius);
    const to = plus(from, way), neck = minus(to, times(way, head / length));
    this.rodFrom(from, neck, thick, colour);
    this.rodFrom(neck, to, 2.5 * thick, colour, this.cone);
  }

  // Contact forces, and how falling bodies start to move.
  answers(ink) {
    if (!report.arrows.length) return;
    const radius = this.sphereAround(report.bodies.ids.map((_, body) => body))[1];
    for (const { from, way, kind } of report.arrows) this.pointer(from, way, radius, kind === "fall" ? ink : GREEN);
  }

  component(item, ink) {
    const { renderer } = this, box = renderer.strip(edgesOf(item.low, item.high));
    const point = renderer.strip([item.point]);
    renderer.draw(box, [...ink, 1], { mode: renderer.gl.LINES, lit: 0 });
    renderer.draw(point, [...YELLOW, 1], { mode: renderer.gl.POINTS, lit: -1 });
    for (const shape of [box, point]) renderer.forget(shape);
  }

  // The shadow of a body as drawn: least and greatest value along the axis.
  shadow(shape, axis) {
    const { corners, rows } = shape;
    const [x, y, z, w] = [0, 1, 2, 3].map((k) => dot(axis, [rows[k], rows[4 + k], rows[8 + k]]));
    let low = Infinity, high = -Infinity;
    for (let k = 0; k < corners.length; k += 3) {
      const at = (x * corners[k] + y * corners[k + 1] + z * corners[k + 2]) / STEPS + w;
      low = Math.min(low, at);
      high = Math.max(high, at);
    }
    return [low, high];
  }

  shadowsOf(now, rung, shapes) {
    if (!this.shadows || this.shadows.rung !== rung) {
      const axis = now.axis ? unit(now.axis) : unit(now.mtv);
      this.shadows = { rung, axis, both: shapes.map((shape) => this.shadow(shape, axis)) };
    }
    return this.shadows;
  }

  // Beside the bodies: both shadows as bars, and below them what they share, or the gap.
  axis(now, view, shapes, labels) {
    const { axis, both } = this.shadowsOf(now, view.rung, shapes);
    const [centre, radius] = this.sphereAround([now.a, now.b]), middle = dot(axis, centre);
    const level = across(axis, view.up), side = cross(level, axis), width = 0.025 * radius;
    const down = dot(side, view.up) > 0 ? times(side, -1) : side;
    const place = (t, off) => plus(plus(centre, times(axis, t - middle)), times(down, off));
    const reach = Math.max(...[now.a, now.b].map((body) => this.reach(body, down, centre))) + 3 * width;
    const step = dot(view.move, axis), a = both[0].map((t) => t + step), b = both[1];
    const bar = ([low, high], row, colour) => {
      if (high > low) this.rodFrom(place(low, reach + 3 * width * row), place(high, reach + 3 * width * row), width, colour);
    };
    const inner = [Math.max(a[0], b[0]), Math.min(a[1], b[1])], apart = inner[0] > inner[1];
    bar(a, 0, A);
    bar(b, 1, B);
    bar(apart ? [inner[1], inner[0]] : inner, 2, apart ? GREEN : RED);
    for (const t of inner) this.rodFrom(place(t, 0), place(t, reach + 7 * width), 0.1 * width, view.ink);
    const length = Math.abs(inner[1] - inner[0]), words = apart ? "shadows apart by" : "shadows overlap by";
    const isNone = length < (2 * radius) / STEPS;
    const text = isNone ? "shadows touch" : `${words} ${rounded(length)} ${report.unit}`.trim();
    labels.push([text, place((inner[0] + inner[1]) / 2, reach + 10 * width), "axis"]);
  }

  reach(body, direction, from) {
    const corners = this.box(body);
    return [0, 1, 2].reduce((sum, k) => sum + Math.max(...corners.map((c) => direction[k] * (c[k] - from[k]))), 0);
  }
}
