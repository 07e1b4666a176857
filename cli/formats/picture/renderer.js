// Draws meshes, one or many at a time, their overlap, lines and points with WebGL 2.
const VERTEX = `#version 300 es
in vec3 corner; in vec4 row0, row1, row2, tint; in float number;
uniform mat4 camera; uniform vec3 move; uniform vec4 colour; uniform vec2 skip; uniform float size, tinted;
out vec3 place; out vec4 shade;
void main() {
  vec4 at = vec4(corner, 1.0);
  place = vec3(dot(row0, at), dot(row1, at), dot(row2, at)) + move;
  bool gone = number >= 0.0 && (number == skip.x || number == skip.y);
  gl_Position = gone ? vec4(2.0, 2.0, 2.0, 1.0) : camera * vec4(place, 1.0);
  gl_PointSize = size;
  shade = vec4(mix(colour.rgb, tint.rgb, tinted), colour.a);
}`;
const FRAGMENT = `#version 300 es
precision highp float; in vec3 place; in vec4 shade; uniform vec3 eye; uniform float lit; out vec4 shown;
void main() {
  float light = 1.0;
  if (lit > 0.5) {
    vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
    light = 0.55 + 0.45 * abs(dot(normal, normalize(eye - place)));
  } else if (lit < -0.5 && length(gl_PointCoord - 0.5) > 0.5) discard;
  shown = vec4(shade.rgb * light * shade.a, shade.a);
}`;
const CORNER = 0, ROWS = [1, 2, 3], TINT = 4, NUMBER = 5;
const SAME = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];

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
    ["corner", "row0", "row1", "row2", "tint", "number"].forEach((name, at) =>
      gl.bindAttribLocation(this.program, at, name));
    gl.linkProgram(this.program);
    gl.useProgram(this.program);
    this.at = {};
    for (const name of ["camera", "move", "colour", "eye", "lit", "skip", "size", "tinted"])
      this.at[name] = gl.getUniformLocation(this.program, name);
  }

  // corners: 16 bits within the box of the mesh, or floats.
  mesh({ corners, triangles }) {
    const gl = this.gl, buffer = this.buffer(corners), indices = triangles && this.buffer(triangles, true);
    const array = this.array(buffer, corners, indices);
    return { array, buffer, indices, corners, count: triangles ? triangles.length : corners.length / 3 };
  }

  buffer(values, isIndex = false) {
    const gl = this.gl, buffer = gl.createBuffer();
    const target = isIndex ? gl.ELEMENT_ARRAY_BUFFER : gl.ARRAY_BUFFER;
    gl.bindVertexArray(null);
    gl.bindBuffer(target, buffer);
    gl.bufferData(target, values, gl.STATIC_DRAW);
    return buffer;
  }

  array(buffer, corners, indices) {
    const gl = this.gl, array = gl.createVertexArray(), whole = corners instanceof Uint16Array;
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(CORNER);
    gl.vertexAttribPointer(CORNER, 3, whole ? gl.UNSIGNED_SHORT : gl.FLOAT, whole, 0, 0);
    if (indices) gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
    return array;
  }

  // Many of one mesh. members: of each 12 numbers of its rows, 3 of its tint, and which `skip` knows.
  crowd(mesh, members) {
    const gl = this.gl, buffer = this.buffer(new Float32Array(members.flat()));
    const array = this.array(mesh.buffer, mesh.corners, mesh.indices);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    [...ROWS.map((at, k) => [at, 4, 4 * k]), [TINT, 3, 12], [NUMBER, 1, 15]].forEach(([at, size, first]) => {
      gl.enableVertexAttribArray(at);
      gl.vertexAttribPointer(at, size, gl.FLOAT, false, 64, 4 * first);
      gl.vertexAttribDivisor(at, 1);
    });
    return { ...mesh, array, buffer, instances: members.length };
  }

  // rows: from the box of the mesh, whose sides are 1, into the page, 3 x 4.
  placed(mesh, rows) {
    const [x, y, z] = [0, 1, 2].map((k) => [rows[k], rows[4 + k], rows[8 + k]]);
    return { ...mesh, rows, mirrored: dot(cross(x, y), z) < 0 };
  }

  // Stays until `forget`: lines and points change with the finding.
  strip(points, rows = SAME) {
    const corners = points instanceof Uint16Array ? points : new Float32Array(points.flat());
    return this.placed(this.mesh({ corners }), rows);
  }

  forget(shape) {
    this.gl.deleteVertexArray(shape.array);
    this.gl.deleteBuffer(shape.buffer);
  }

  begin(ground, camera, eye) {
    const gl = this.gl, canvas = this.canvas, ratio = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((v) => Math.max(1, Math.round(v * ratio)));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.clearColor(...ground, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.uniformMatrix4fv(this.at.camera, false, camera);
    gl.uniform3fv(this.at.eye, eye);
    gl.uniform1f(this.at.size, 10 * ratio);
  }

  // lit: 1 shaded, 0 plain, -1 round points. range: first and count of indices.
  draw(shape, colour, { move = [0, 0, 0], mode = this.gl.TRIANGLES, lit = 1, range = null } = {}) {
    const gl = this.gl;
    gl.uniform3fv(this.at.move, move);
    gl.uniform4fv(this.at.colour, colour);
    gl.uniform1f(this.at.lit, lit);
    gl.uniform1f(this.at.tinted, 0);
    ROWS.forEach((at, k) => gl.vertexAttrib4fv(at, shape.rows.slice(4 * k, 4 * k + 4)));
    gl.vertexAttrib1f(NUMBER, -1);
    gl.frontFace(shape.mirrored ? gl.CW : gl.CCW);
    gl.bindVertexArray(shape.array);
    const [first, count] = range || [0, shape.count];
    if (shape.indices) gl.drawElements(mode, count, gl.UNSIGNED_INT, 4 * first);
    else gl.drawArrays(mode, first, count);
  }

  // alpha 1: solid, in their own tints; else all in one colour, and none hides another.
  drawCrowd(crowd, colour, skip, tinted) {
    const gl = this.gl;
    gl.uniform3fv(this.at.move, [0, 0, 0]);
    gl.uniform4fv(this.at.colour, colour);
    gl.uniform1f(this.at.lit, 1);
    gl.uniform1f(this.at.tinted, tinted ? 1 : 0);
    gl.uniform2fv(this.at.skip, skip);
    gl.depthMask(colour[3] === 1);
    gl.bindVertexArray(crowd.array);
    gl.drawElementsInstanced(gl.TRIANGLES, crowd.count, gl.UNSIGNED_INT, 0, crowd.instances);
    gl.depthMask(true);
  }

  // Far sides first; nothing hides what is behind it.
  translucent(shape, colour, options) {
    const gl = this.gl;
    gl.depthMask(false);
    gl.enable(gl.CULL_FACE);
    for (const side of [gl.FRONT, gl.BACK]) {
      gl.cullFace(side);
      this.draw(shape, colour, options);
    }
    gl.disable(gl.CULL_FACE);
    gl.depthMask(true);
  }

  // What comes now lies in front of everything.
  onTop() {
    this.gl.clear(this.gl.DEPTH_BUFFER_BIT);
  }

  // Where the front of one body lies inside the other: between the eye and a point there, the
  // stencil counts how often the ray enters and leaves the other body.
  overlap(shape, move, other, otherMove, colour) {
    const gl = this.gl;
    gl.clear(gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    gl.colorMask(false, false, false, false);
    this.draw(shape, colour, { move });
    gl.depthMask(false);
    gl.enable(gl.STENCIL_TEST);
    gl.stencilFunc(gl.ALWAYS, 0, 255);
    gl.stencilOpSeparate(gl.FRONT, gl.KEEP, gl.KEEP, gl.INCR_WRAP);
    gl.stencilOpSeparate(gl.BACK, gl.KEEP, gl.KEEP, gl.DECR_WRAP);
    gl.depthFunc(gl.LESS);
    // A face of the other body that coincides is neither entered nor left: bodies only touch there. A GPU
    // may round corners to a 16th of a pixel, which moves each of two faces by a 32nd along x and along y.
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.enable(gl.CULL_FACE);
    for (const [hidden, away] of [[gl.BACK, 1], [gl.FRONT, -1]]) {
      gl.cullFace(hidden);
      gl.polygonOffset(away / 8, 8 * away);
      this.draw(other, colour, { move: otherMove });
    }
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.colorMask(true, true, true, true);
    gl.stencilFunc(gl.NOTEQUAL, 0, 255);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.KEEP);
    gl.depthFunc(gl.LEQUAL);
    this.draw(shape, colour, { move });
    gl.disable(gl.STENCIL_TEST);
    gl.depthFunc(gl.LESS);
    gl.depthMask(true);
  }
}
