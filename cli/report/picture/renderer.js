// Draws bodies, their overlap, lines and arrows with WebGL 2. z is up.
"use strict";

const VERTEX = `#version 300 es
in vec3 corner; uniform mat4 camera, frame; uniform vec3 move; out vec3 place;
void main() { place = (frame * vec4(corner, 1.0)).xyz + move; gl_Position = camera * vec4(place, 1.0); }`;
const FRAGMENT = `#version 300 es
precision highp float; in vec3 place; uniform vec4 colour; uniform vec3 eye; uniform float lit; out vec4 shown;
void main() {
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  float light = lit > 0.5 ? 0.55 + 0.45 * abs(dot(normal, normalize(eye - place))) : 1.0;
  shown = vec4(colour.rgb * light * colour.a, colour.a);
}`;

async function unpacked(geometry) {
  const bytes = Uint8Array.from(atob(geometry.data), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const raw = await new Response(stream).arrayBuffer();
  const indices = Math.ceil((geometry.vertices * 6) / 4) * 4;
  return {
    corners: new Uint16Array(raw, 0, geometry.vertices * 3),
    triangles: new Uint32Array(raw, indices, geometry.triangles * 3),
  };
}

class Renderer {
  constructor(canvas) {
    this.canvas = canvas;
    const options = { antialias: true, stencil: true, premultipliedAlpha: true };
    const gl = (this.gl = canvas.getContext("webgl2", options));
    if (!gl) throw new Error("This browser has no WebGL 2.");
    this.program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(this.program, shader);
    }
    gl.bindAttribLocation(this.program, 0, "corner");
    gl.linkProgram(this.program);
    gl.useProgram(this.program);
    this.at = {};
    for (const name of ["camera", "frame", "move", "colour", "eye", "lit"])
      this.at[name] = gl.getUniformLocation(this.program, name);
  }

  async mesh(geometry) {
    const { corners, triangles } = await unpacked(geometry);
    const array = this.array(corners, this.gl.UNSIGNED_SHORT);
    this.gl.bindBuffer(this.gl.ELEMENT_ARRAY_BUFFER, this.gl.createBuffer());
    this.gl.bufferData(this.gl.ELEMENT_ARRAY_BUFFER, triangles, this.gl.STATIC_DRAW);
    this.gl.bindVertexArray(null);
    return { array, count: triangles.length };
  }

  // rows: from the box of the mesh, whose sides are 1, into the scene, 3 x 4.
  placed(mesh, rows) {
    const frame = new Float32Array(16);
    for (let k = 0; k < 12; k++) frame[(k % 4) * 4 + Math.floor(k / 4)] = rows[k];
    frame[15] = 1;
    const [x, y, z] = [0, 1, 2].map((k) => [rows[k], rows[4 + k], rows[8 + k]]);
    return { ...mesh, frame, mirrored: dot(cross(x, y), z) < 0 };
  }

  lines(points) {
    const array = this.array(new Float32Array(points.flat()), this.gl.FLOAT);
    this.gl.bindVertexArray(null);
    return this.placed({ array, count: points.length }, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]);
  }

  array(values, type) {
    const gl = this.gl, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, type, type === gl.UNSIGNED_SHORT, 0, 0);
    return array;
  }

  begin(ground, camera, eye) {
    const gl = this.gl, canvas = this.canvas, ratio = window.devicePixelRatio || 1;
    canvas.width = Math.max(1, canvas.clientWidth * ratio);
    canvas.height = Math.max(1, canvas.clientHeight * ratio);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...ground, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.uniformMatrix4fv(this.at.camera, false, camera);
    gl.uniform3fv(this.at.eye, eye);
  }

  draw(shape, colour, move = [0, 0, 0], mode = this.gl.TRIANGLES, lit = 1) {
    const gl = this.gl;
    gl.uniformMatrix4fv(this.at.frame, false, shape.frame);
    gl.frontFace(shape.mirrored ? gl.CW : gl.CCW);
    gl.uniform3fv(this.at.move, move);
    gl.uniform4fv(this.at.colour, colour);
    gl.uniform1f(this.at.lit, lit);
    gl.bindVertexArray(shape.array);
    if (mode === gl.TRIANGLES) gl.drawElements(mode, shape.count, gl.UNSIGNED_INT, 0);
    else gl.drawArrays(mode, 0, shape.count);
  }

  // Far sides first; nothing hides what is behind it.
  translucent(shape, colour, move) {
    const gl = this.gl;
    gl.depthMask(false);
    gl.enable(gl.CULL_FACE);
    for (const side of [gl.FRONT, gl.BACK]) {
      gl.cullFace(side);
      this.draw(shape, colour, move);
    }
    gl.disable(gl.CULL_FACE);
    gl.depthMask(true);
  }

  // Where the front of one body lies inside the other: between the eye and a point there, the
  // stencil counts how often the ray enters and leaves the other body.
  overlap(shape, move, other, otherMove, colour) {
    const gl = this.gl;
    gl.clear(gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.colorMask(false, false, false, false);
    this.draw(shape, colour, move);
    gl.depthMask(false);
    gl.enable(gl.STENCIL_TEST);
    gl.stencilFunc(gl.ALWAYS, 0, 255);
    gl.stencilOpSeparate(gl.FRONT, gl.KEEP, gl.KEEP, gl.INCR_WRAP);
    gl.stencilOpSeparate(gl.BACK, gl.KEEP, gl.KEEP, gl.DECR_WRAP);
    gl.depthFunc(gl.LESS);
    // A face of the other body that coincides is neither entered nor left: bodies only touch there.
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.enable(gl.CULL_FACE);
    for (const [hidden, away] of [[gl.BACK, 1], [gl.FRONT, -1]]) {
      gl.cullFace(hidden);
      gl.polygonOffset(away, 8 * away);
      this.draw(other, colour, otherMove);
    }
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.colorMask(true, true, true, true);
    gl.stencilFunc(gl.NOTEQUAL, 0, 255);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.KEEP);
    gl.depthFunc(gl.LEQUAL);
    this.draw(shape, colour, move);
    gl.disable(gl.STENCIL_TEST);
    gl.depthFunc(gl.LESS);
    gl.depthMask(true);
  }
}

const minus = (a, b) => a.map((v, k) => v - b[k]);
const plus = (a, b) => a.map((v, k) => v + b[k]);
const times = (a, s) => a.map((v) => v * s);
const dot = (a, b) => a.reduce((sum, v, k) => sum + v * b[k], 0);
const norm = (a) => Math.hypot(...a);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

class Camera {
  constructor() {
    Object.assign(this, { yaw: -0.7, pitch: 0.5, far: 10, target: [0, 0, 0] });
  }

  get axis() {
    const c = Math.cos(this.pitch);
    return [c * Math.cos(this.yaw), c * Math.sin(this.yaw), Math.sin(this.pitch)];
  }

  get eye() {
    return plus(this.target, times(this.axis, this.far));
  }

  get side() {
    return [-Math.sin(this.yaw), Math.cos(this.yaw), 0];
  }

  get up() {
    return cross(this.axis, this.side);
  }

  frame(target, radius) {
    this.target = target;
    this.far = Math.max(radius, 1e-12) * 3.2;
  }

  // Column by column, for WebGL. Right-handed, looking along -axis.
  matrix(aspect) {
    const eye = this.eye, rows = [this.side, this.up, this.axis], f = 2.2;
    const near = this.far / 100, far = this.far * 100, d = near - far;
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
}
