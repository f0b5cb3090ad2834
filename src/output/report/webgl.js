// The picture by WebGL 2: one arrow, drawn once for each spin, lit from the eye's left shoulder; an outline, which is the arrow's
// inside drawn a little larger, keeps white and black arrows apart from any background.

const ARROWS = `#version 300 es
in vec3 corner; in vec3 normal; in vec3 hull;
in vec3 place; in vec3 spin; in vec3 colour;
uniform mat4 projection; uniform mat3 turned; uniform vec2 pixel; uniform float outline;
out vec3 facing; out vec3 paint;
void main() {
  vec3 side = abs(spin.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
  vec3 a = normalize(cross(side, spin)), b = cross(spin, a);
  mat3 along = mat3(a, b, spin);
  gl_Position = projection * vec4(place + along * corner, 1.0);
  vec3 out_ward = turned * (along * hull);
  gl_Position.xy += outline * out_ward.xy / max(length(out_ward.xy), 0.2) * pixel * gl_Position.w;
  facing = turned * (along * normal);
  paint = colour;
}`;
const SHADE = `#version 300 es
precision highp float;
in vec3 facing; in vec3 paint;
uniform float outline; uniform vec3 ink;
out vec4 result;
void main() {
  vec3 n = normalize(facing);
  float light = 0.72 + 0.31 * max(0.0, dot(n, vec3(-0.40, 0.58, 0.71)));
  float glint = 0.16 * pow(max(0.0, dot(n, vec3(-0.22, 0.32, 0.92))), 24.0);
  result = outline > 0.0 ? vec4(ink, 1.0) : vec4(paint * light + glint, 1.0);
}`;
const DISCS = `#version 300 es
in vec3 place; in vec3 colour;
uniform mat4 projection; uniform float size;
out vec3 paint;
void main() {
  gl_Position = projection * vec4(place, 1.0);
  gl_PointSize = max(size / gl_Position.w, 1.5);
  paint = colour;
}`;
const ROUND = `#version 300 es
precision highp float;
in vec3 paint;
out vec4 result;
void main() {
  vec2 at = 2.0 * gl_PointCoord - 1.0;
  float far = dot(at, at);
  if (far > 1.0) discard;
  result = vec4(paint * (far > 0.7 ? 0.86 : 1.0), 1.0);
}`;
const LINES = `#version 300 es
in vec3 place;
uniform mat4 projection;
void main() { gl_Position = projection * vec4(place, 1.0); }`;
const PLAIN = `#version 300 es
precision highp float;
uniform vec3 ink;
out vec4 result;
void main() { result = vec4(ink, 1.0) * 0.55; }`;

/** The mesh of an arrow along +z about its middle, a row a corner: place, normal, normal of the smoothed hull. */
function arrowMesh({ length, head, shaft, point }, sides) {
  const [low, neck, tip] = [-length / 2, length / 2 - point, length / 2];
  const outline = [[0, low], [shaft, low], [shaft, neck], [head, neck], [0, tip]];
  const normals = outline.slice(1).map(([r, z], k) => {
    const [dr, dz] = [r - outline[k][0], z - outline[k][1]];
    return [dz / Math.hypot(dr, dz), -dr / Math.hypot(dr, dz)];
  });
  const hulls = outline.map((_, k) => {
    const sum = [0, 1].map(c => (normals[k - 1]?.[c] ?? 0) + (normals[k]?.[c] ?? 0));
    if (outline[k][0] === 0) sum[0] = 0;
    return sum.map(c => c / Math.hypot(...sum));
  });
  const rows = [];
  const corner = (k, piece, j) => {
    const [cos, sin] = [Math.cos((2 * Math.PI * j) / sides), Math.sin((2 * Math.PI * j) / sides)];
    const turned = ([r, z]) => [r * cos, r * sin, z];
    rows.push(...turned(outline[k]), ...turned(normals[piece]), ...turned(hulls[k]));
  };
  for (let k = 0; k < normals.length; k++) {
    for (let j = 0; j < sides; j++) {
      for (const [end, step] of [[k, 0], [k, 1], [k + 1, 1], [k, 0], [k + 1, 1], [k + 1, 0]]) corner(end, k, j + step);
    }
  }
  return new Float32Array(rows);
}

class Glass {
  /** A renderer, or nothing where the browser has no WebGL 2. */
  static on(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: true });
    return gl ? new Glass(gl) : null;
  }

  constructor(gl) {
    this.gl = gl;
    this.arrows = this.program(ARROWS, SHADE);
    this.discs = this.program(DISCS, ROUND);
    this.lines = this.program(LINES, PLAIN);
    this.buffers = Object.fromEntries(["mesh", "place", "spin", "colour", "line"].map(name => [name, gl.createBuffer()]));
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(`WebGL: ${gl.getProgramInfoLog(program)}`);
    return program;
  }

  fill(name, numbers) {
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.buffers[name]);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, numbers, this.gl.DYNAMIC_DRAW);
  }

  /** After a change of the sites' places or the arrows' measures. */
  build(scene) {
    const mesh = arrowMesh(scene.arrow, scene.live.length > 2000 ? 7 : scene.live.length > 300 ? 12 : 24);
    this.corners = mesh.length / 9;
    this.fill("mesh", mesh);
    const places = new Float32Array(3 * scene.live.length);
    scene.live.forEach((k, j) => places.set(scene.places[k], 3 * j));
    this.fill("place", places);
    const ends = scene.bonds().flat();
    this.joints = ends.length;
    this.fill("line", new Float32Array(ends.flatMap(k => scene.places[k])));
  }

  attribute(program, name, buffer, stride, offset, divisor) {
    const gl = this.gl, at = gl.getAttribLocation(program, name);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[buffer]);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, 3, gl.FLOAT, false, stride, offset);
    gl.vertexAttribDivisor(at, divisor);
  }

  /** All sites as discs that touch. */
  drawDiscs(scene, camera, projection, ratio) {
    const gl = this.gl;
    gl.useProgram(this.discs);
    gl.uniformMatrix4fv(gl.getUniformLocation(this.discs, "projection"), false, projection);
    gl.uniform1f(gl.getUniformLocation(this.discs, "size"), 1.04 * scene.stretch * camera.scale * ratio);
    for (const name of ["place", "colour"]) this.attribute(this.discs, name, name, 12, 0, 0);
    gl.drawArrays(gl.POINTS, 0, scene.live.length);
  }

  draw(scene, camera, ink, ratio) {
    const gl = this.gl;
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    const projection = matrix(camera);
    const uniform = (program, name) => gl.getUniformLocation(program, name);

    gl.useProgram(this.lines);
    gl.uniformMatrix4fv(uniform(this.lines, "projection"), false, projection);
    gl.uniform3fv(uniform(this.lines, "ink"), ink);
    this.attribute(this.lines, "place", "line", 12, 0, 0);
    gl.drawArrays(gl.LINES, 0, this.joints);

    this.fill("colour", scene.colour);
    if (scene.discs) return this.drawDiscs(scene, camera, projection, ratio);
    this.fill("spin", scene.world);
    const program = this.arrows;
    gl.useProgram(program);
    ["corner", "normal", "hull"].forEach((name, k) => this.attribute(program, name, "mesh", 36, 12 * k, 0));
    ["place", "spin", "colour"].forEach(name => this.attribute(program, name, name, 12, 0, 1));
    const { right, up, eye } = camera;
    gl.uniformMatrix4fv(uniform(program, "projection"), false, projection);
    gl.uniformMatrix3fv(uniform(program, "turned"), false, [0, 1, 2].flatMap(c => [right[c], up[c], eye[c]]));
    gl.uniform2f(uniform(program, "pixel"), (2 * ratio) / gl.drawingBufferWidth, (2 * ratio) / gl.drawingBufferHeight);
    gl.uniform3fv(uniform(program, "ink"), ink);
    gl.enable(gl.CULL_FACE);
    const [, , , perSite] = project(camera, camera.target);
    for (const [face, outline] of [[gl.BACK, 0], [gl.FRONT, clamp(0.09 * perSite, 0.5, 1.0)]]) {
      gl.cullFace(face);
      gl.uniform1f(uniform(program, "outline"), outline);
      gl.drawArraysInstanced(gl.TRIANGLES, 0, this.corners, scene.live.length);
    }
    gl.disable(gl.CULL_FACE);
  }
}

/** Perspective, column by column: clip = projection · (place, 1). */
function matrix({ right, up, eye, target, distance, width, height }) {
  const far = 4 * distance + 1000, near = distance / 200;
  const [x, y] = [height / (width * Scene.TAN), 1 / Scene.TAN];
  const [p, q] = [-(far + near) / (far - near), (-2 * far * near) / (far - near)];
  const [r, u, e] = [right, up, eye].map(axis => -dot(axis, target));
  const column = c => [x * right[c], y * up[c], p * eye[c], -eye[c]];
  return [...column(0), ...column(1), ...column(2), x * r, y * u, p * (e - distance) + q, distance - e];
}
