const minus = (a, b) => a.map((v, k) => v - b[k]);
const plus = (a, b) => a.map((v, k) => v + b[k]);
const times = (a, s) => a.map((v) => v * s);
const dot = (a, b) => a.reduce((sum, v, k) => sum + v * b[k], 0);
const norm = (a) => Math.hypot(...a);
const unit = (a) => times(a, 1 / norm(a));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
// A unit vector at a right angle to a, and to b unless that is parallel.
const across = (a, b = [0, 0, 1]) => {
  const normal = cross(a, b);
  return norm(normal) > 0.1 * norm(a) ? unit(normal) : across(a, [b[2], b[0], b[1]]);
};

const LENS = 2.2;

// Looks at a target. far: how much is seen. back: the eye is so many times as far away, and its angle as much
// smaller, so that it stands outside of the bodies.
class Camera {
  constructor(upwards) {
    Object.assign(this, { yaw: -0.7, pitch: 0.5, far: 10, back: 1, target: [0, 0, 0], upwards });
  }

  // From a frame whose z is up.
  world([x, y, z]) {
    return this.upwards === "y" ? [y, z, x] : [x, y, z];
  }

  get axis() {
    const c = Math.cos(this.pitch);
    return this.world([c * Math.cos(this.yaw), c * Math.sin(this.yaw), Math.sin(this.pitch)]);
  }

  get eye() {
    return plus(this.target, times(this.axis, this.far * this.back));
  }

  get side() {
    return this.world([-Math.sin(this.yaw), Math.cos(this.yaw), 0]);
  }

  get up() {
    return cross(this.axis, this.side);
  }

  // As viewpoint.py says. Without towards the direction stays.
  frame({ target, radius, towards, clear = 0 }) {
    this.target = target;
    this.far = Math.max(radius, 1e-12) * 2.6;
    this.back = Math.max(1, (1.2 * clear) / this.far);
    if (!towards) return;
    const [x, y, z] = this.upwards === "y" ? [towards[2], towards[0], towards[1]] : towards;
    Object.assign(this, { yaw: Math.atan2(y, x), pitch: Math.asin(Math.max(-1, Math.min(1, z))) });
  }

  // The length of a pixel at the target, in a view of this height.
  pixel(height) {
    return (2 * this.far) / (LENS * height);
  }

  turn(x, y) {
    this.yaw -= x;
    this.pitch = Math.max(-1.55, Math.min(1.55, this.pitch + y));
  }

  // x, y: in heights of the view.
  shift(x, y) {
    const shift = plus(times(this.side, -x * this.far), times(this.up, y * this.far));
    this.target = plus(this.target, shift);
  }

  // Column by column, for WebGL. Right-handed, looking along -axis.
  matrix(aspect) {
    const eye = this.eye, rows = [this.side, this.up, this.axis], f = LENS * this.back;
    const reach = this.far * this.back, near = reach / 100, far = reach * 100, d = near - far;
    const p = [f / aspect, f, (far + near) / d];
    const out = new Float32Array(16);
    rows.forEach((row, r) => {
      row.forEach((v, k) => (out[k * 4 + r] = v * p[r]));
      out[12 + r] = -dot(row, eye) * p[r];
    });
    this.axis.forEach((v, k) => (out[k * 4 + 3] = -v));
    out[14] += (2 * far * near) / d;
    out[15] = dot(this.axis, eye);
    return out;
  }

  // Of a point: [x, y] from the left upper corner in parts of the view, or null behind the eye.
  seen(point, aspect) {
    const m = this.matrix(aspect), p = [...point, 1];
    const [x, y, , w] = [0, 1, 2, 3].map((r) => p.reduce((sum, v, k) => sum + v * m[k * 4 + r], 0));
    return w > 0 ? [(1 + x / w) / 2, (1 - y / w) / 2] : null;
  }
}
