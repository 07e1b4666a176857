// Geometry as packing.py wrote it: base64, deflated, bytes of one weight together.
async function unpacked(text, Numbers) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const size = Numbers.BYTES_PER_ELEMENT, count = planes.length / size;
  const rows = new Uint8Array(planes.length);
  for (let plane = 0; plane < size; plane++)
    for (let k = 0; k < count; k++) rows[k * size + plane] = planes[plane * count + k];
  return new Numbers(rows.buffer);
}

// Typed arrays of integers wrap around, as the differences do.
function sums(differences) {
  for (let k = 1; k < differences.length; k++) differences[k] += differences[k - 1];
  return differences;
}

const unpackedText = async (text) => new TextDecoder().decode(await unpacked(text, Uint8Array));

// From columns of differences to rows.
async function unpackedPoints(text) {
  const columns = sums(await unpacked(text, Uint16Array)), count = columns.length / 3;
  const points = new Uint16Array(columns.length);
  for (let k = 0; k < count; k++)
    for (let axis = 0; axis < 3; axis++) points[3 * k + axis] = columns[axis * count + k];
  return points;
}

async function unpackedMesh(mesh) {
  const [corners, differences] = [await unpackedPoints(mesh.corners), await unpacked(mesh.triangles, Uint32Array)];
  return { corners, triangles: sums(differences) };
}

// Meshes of simple solids, for what is drawn beside the bodies.
function turned(profile, segments = 24) {
  const corners = [], triangles = [];
  for (let k = 0; k < segments; k++) {
    const angle = (2 * Math.PI * k) / segments;
    for (const [r, z] of profile) corners.push(r * Math.cos(angle), r * Math.sin(angle), z);
    for (let j = 0; j + 1 < profile.length; j++) {
      const here = k * profile.length + j, next = ((k + 1) % segments) * profile.length + j;
      triangles.push(here, next, next + 1, here, next + 1, here + 1);
    }
  }
  return { corners: new Float32Array(corners), triangles: new Uint32Array(triangles) };
}

const arc = Array.from({ length: 13 }, (_, k) => (Math.PI * k) / 12 - Math.PI / 2);
const SPHERE = turned(arc.map((t) => [Math.cos(t), Math.sin(t)]));
const ROD = turned([[0, 0], [1, 0], [1, 1], [0, 1]]); // around z, from 0 to 1
const CONE = turned([[0, 0], [1, 0], [0, 1]]);
const CUBE = {
  corners: new Float32Array([0, 1, 2, 3, 4, 5, 6, 7].flatMap((k) => [k & 1, (k >> 1) & 1, k >> 2])),
  triangles: new Uint32Array([
    0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5,
  ]),
};
// Pairs of corners that differ in one coordinate.
const EDGES = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((a) => [1, 2, 4].filter((bit) => !(a & bit)).map((bit) => [a, a | bit]));

// Rows of a 3 x 4 matrix: where the axes of a solid and its origin come to lie.
const rowsOf = (x, y, z, origin) => [0, 1, 2].flatMap((k) => [x[k], y[k], z[k], origin[k]]);
const boxRows = (low, size) => rowsOf([size[0], 0, 0], [0, size[1], 0], [0, 0, size[2]], low);
const ballRows = (centre, r) => boxRows(centre, [r, r, r]);
const edgesOf = (low, high) =>
  EDGES.flat().flatMap((corner) => [0, 1, 2].map((k) => ((corner >> k) & 1 ? high : low)[k]));
