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

// Pairs of corners that differ in one coordinate.
const EDGES = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((a) => [1, 2, 4].filter((bit) => !(a & bit)).map((bit) => [a, a | bit]));

// Rows of a 3 x 4 matrix: where the sides of the box of a mesh and its least corner come to lie.
const rowsOf = (x, y, z, origin) => [0, 1, 2].flatMap((k) => [x[k], y[k], z[k], origin[k]]);
const boxRows = (low, size) => rowsOf([size[0], 0, 0], [0, size[1], 0], [0, 0, size[2]], low);
const ballRows = (centre, r) => boxRows(minus(centre, [r, r, r]), [2 * r, 2 * r, 2 * r]);
const edgesOf = (low, high) =>
  EDGES.flat().flatMap((corner) => [0, 1, 2].map((k) => ((corner >> k) & 1 ? high : low)[k]));
