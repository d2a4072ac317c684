"use strict";
// The picture of the pages: a small WebGL 2 viewer without any library. Data as `viewer.py` writes them: lengths over
// scene.scale about scene.centre; arrays as base64, little-endian.
const scene = JSON.parse(document.getElementById("scene").textContent);
const $ = id => document.getElementById(id);
const decode = (text, Type) => new Type(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer);
const closed = [...scene.problems.keys()].filter(pose => scene.problems[pose] === "");
const FIELD = Math.tan(13 * Math.PI / 180);  // half the field of view, upwards: narrow, so that parallels look parallel
const LIFT = 0.08;  // of half the height: the controls are at the bottom
const CLOSEST = 100;  // times that the whole is magnified at most
const NONE = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]);
let pose = closed.length ? closed[0] : 0;
let yaw, pitch, zoom, shift, target = [0, 0, 0];  // the turntable turns about the target

// ---- camera: a turntable about the upward axis; the rows of scene.axes are right, up, towards the viewer ----
function turned() {
  const c = Math.cos(yaw), s = Math.sin(yaw), d = Math.cos(pitch), t = Math.sin(pitch);
  const turn = [[c, 0, s], [s * t, d, -c * t], [-s * d, t, c * d]];
  return turn.map(row => [0, 1, 2].map(j => dot3(row, scene.axes.map(axis => axis[j]))));
}

const dot3 = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

function camera(aspect) {  // everything that is ever drawn fits between the controls at zoom 1
  const rows = turned();
  let distance = 0;
  for (const corner of scene.corners) {
    const [x, y, z] = rows.map(row => dot3(row, corner));
    distance = Math.max(distance, z + Math.abs(x) / (0.88 * FIELD * aspect), z + Math.abs(y) / (0.74 * FIELD));
  }
  distance /= zoom;
  const [right, up, out] = rows.map(row => dot3(row, target)), reach = 1.5 + Math.hypot(...target);
  const near = Math.max(distance - reach, distance / 10), far = distance + reach;
  const scale = [1 / (FIELD * aspect), 1 / FIELD], depth = (far + near) / (far - near), away = distance + out;
  const clip = [0, 1, 2].flatMap(j => [scale[0] * rows[0][j], scale[1] * rows[1][j], -depth * rows[2][j], -rows[2][j]]);
  const moved = [shift[0] * distance - right, (shift[1] + LIFT * FIELD) * distance - up];
  clip.push(scale[0] * moved[0], scale[1] * moved[1], depth * away - 2 * far * near / (far - near), away);
  return { clip, view: [0, 1, 2].flatMap(j => rows.map(row => row[j])) };
}

function lookFrom(newYaw, newPitch) {
  [yaw, pitch, zoom, shift, target] = [newYaw, newPitch, 1, [0, 0], [0, 0, 0]];
  redraw();
}

function lookAt(place, radius) {  // from the same side, so near that so much around the place fills a part of the picture
  [target, zoom, shift] = [place, Math.min(CLOSEST, Math.max(1, 0.6 / radius)), [0, 0]];
  redraw();
}

// ---- WebGL ----
const gl = $("canvas").getContext("webgl2", { antialias: true, alpha: false, stencil: true });

function program(vertex, fragment) {
  const made = gl.createProgram(), at = {};
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, "#version 300 es\nprecision highp float;\n" + source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  for (let i = 0; i < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); i++) {
    const { name } = gl.getActiveUniform(made, i);
    at[name] = gl.getUniformLocation(made, name);
  }
  return { made, at };
}

function attribute(place, type, stride, offset, divisor) {
  gl.enableVertexAttribArray(place);
  gl.vertexAttribPointer(place, 3, type, type === gl.BYTE, stride, offset);
  gl.vertexAttribDivisor(place, divisor);
}

function load(target, data) {
  gl.bindBuffer(target, gl.createBuffer());
  gl.bufferData(target, data, gl.STATIC_DRAW);
}

function loadMesh(part) {
  const array = gl.createVertexArray(), indices = decode(part.triangles, Uint32Array);
  gl.bindVertexArray(array);
  load(gl.ARRAY_BUFFER, decode(part.points, Float32Array));
  attribute(0, gl.FLOAT, 0, 0, 0);
  load(gl.ARRAY_BUFFER, decode(part.normals, Int8Array));
  attribute(1, gl.BYTE, 4, 0, 0);
  load(gl.ELEMENT_ARRAY_BUFFER, indices);
  return { array, count: indices.length };
}

function loadLines(numbers) {  // six numbers a line
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  load(gl.ARRAY_BUFFER, numbers);
  attribute(0, gl.FLOAT, 24, 0, 1);
  attribute(1, gl.FLOAT, 24, 12, 1);
  return { array, count: numbers.length / 6 };
}

function links(points) {  // the lines of a path; it is NaN where the mechanism could not be closed
  const numbers = [];
  for (let i = 0; i + 6 <= points.length; i += 3) {
    const link = points.subarray(i, i + 6);
    if (link.every(Number.isFinite)) numbers.push(...link);
  }
  return new Float32Array(numbers);
}

const FACES = [`
  layout(location=0) in vec3 point; layout(location=1) in vec3 normal;
  uniform mat4 clip, model; uniform mat3 view; out vec3 facing;
  void main() { facing = view * mat3(model) * normal; gl_Position = clip * model * vec4(point, 1.0); }`, `
  in vec3 facing; uniform vec4 color; uniform bool flatly; out vec4 pixel;
  void main() {
    if (flatly) { pixel = color; return; }
    vec3 n = normalize(facing) * (gl_FrontFacing ? 1.0 : -1.0);
    float light = 0.58 + 0.12 * n.y + 0.44 * max(dot(n, normalize(vec3(-0.25, 0.32, 0.91))), 0.0);
    float shine = 0.10 * pow(max(dot(n, normalize(vec3(-0.2, 0.35, 0.92))), 0.0), 40.0);
    pixel = vec4(color.rgb * light + shine, color.a);
  }`];
const LINES = [`
  layout(location=0) in vec3 start; layout(location=1) in vec3 end;
  uniform mat4 clip, model; uniform vec2 size; uniform float width, nearer; out vec2 place; out float span;
  void main() {  // a box around the line, in pixels; longer than it at both ends by the round caps
    vec4 a = clip * model * vec4(start, 1.0), b = clip * model * vec4(end, 1.0);
    vec2 p = 0.5 * a.xy / a.w * size, q = 0.5 * b.xy / b.w * size, along = q - p;
    span = length(along);
    along = span > 1e-4 ? along / span : vec2(1.0, 0.0);
    bool second = gl_VertexID > 1; float reach = 0.5 * width + 1.0;
    place = vec2(second ? span + reach : -reach, gl_VertexID % 2 == 0 ? -reach : reach);
    vec2 spot = p + along * place.x + vec2(-along.y, along.x) * place.y;
    float w = second ? b.w : a.w, z = second ? b.z : a.z;
    gl_Position = vec4(2.0 * spot / size * w, z - nearer * w, w);
  }`, `
  in vec2 place; in float span; uniform float width; uniform vec4 color; out vec4 pixel;
  void main() {
    float gap = length(vec2(place.x - clamp(place.x, 0.0, span), place.y)) - 0.5 * width;
    if (gap > 0.5) discard;
    pixel = vec4(color.rgb, color.a * min(0.5 - gap, 1.0));
  }`];

// ---- drawing ----
const WARNING = [0.80, 0.07, 0.12, 1];
let faces, lines, bodies, parts, paths, marks, dot, waiting = false;

function prepare() {
  [faces, lines] = [program(...FACES), program(...LINES)];
  dot = loadLines(new Float32Array(6));  // a line without length: a disc
  bodies = scene.bodies.map(body => ({
    ...body, shown: true, poses: body.poses === "" ? null : decode(body.poses, Float32Array),
  }));
  parts = scene.parts.map(part => ({
    ...part, mesh: loadMesh(part), edges: loadLines(decode(part.edges, Float32Array)),
    body: bodies[part.body], alpha: 1,
  }));
  paths = scene.paths.map(path => {
    const points = decode(path.points, Float32Array);
    return { ...path, shown: true, points, lines: loadLines(links(points)) };
  });
  marks = scene.marks.map(ends => ends.map(points => decode(points, Float32Array)));
}

function model(body) {  // twelve numbers a pose, row by row; none for a body that never moves
  const m = body.poses ? body.poses.subarray(12 * pose, 12 * pose + 12) : NONE;
  return [0, 1, 2, 3].flatMap(j => [m[j], m[4 + j], m[8 + j], j === 3 ? 1 : 0]);
}

function drawLines(set, matrix, color, width, nearer = 1e-3) {
  gl.bindVertexArray(set.array);
  gl.uniformMatrix4fv(lines.at.model, false, matrix);
  gl.uniform4fv(lines.at.color, color);
  gl.uniform1f(lines.at.width, width * devicePixelRatio);
  gl.uniform1f(lines.at.nearer, nearer);
  gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, set.count);
}

function drawFaces(set, clip, view, colorOf, flatly = false) {
  gl.useProgram(faces.made);
  gl.uniformMatrix4fv(faces.at.clip, false, clip);
  gl.uniformMatrix3fv(faces.at.view, false, view);
  gl.uniform1i(faces.at.flatly, flatly);
  for (const part of set) {
    gl.uniformMatrix4fv(faces.at.model, false, model(part.body));
    gl.uniform4fv(faces.at.color, colorOf(part));
    gl.bindVertexArray(part.mesh.array);
    gl.drawElements(gl.TRIANGLES, part.mesh.count, gl.UNSIGNED_INT, 0);
  }
}

function drawnParts() {  // solid ones, and those that the others are seen through
  const ok = scene.problems[pose] === "", drawn = parts.filter(part => part.body.shown && (ok || part.body.fixed));
  return [drawn.filter(part => part.alpha === 1), drawn.filter(part => part.alpha < 1)];
}

function draw() {
  waiting = false;
  const canvas = $("canvas"), style = getComputedStyle(document.body), dark = matchMedia("(prefers-color-scheme: dark)").matches;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight].map(side => Math.round(side * devicePixelRatio));
  if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
  const { clip, view } = camera(canvas.width / canvas.height), paper = style.backgroundColor.match(/[\d.]+/g).map(c => c / 255);
  const [solid, faded] = drawnParts();
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.clearColor(paper[0], paper[1], paper[2], 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl.LEQUAL);
  gl.disable(gl.BLEND);
  drawFaces(solid, clip, view, part => [...part.color, 1]);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.depthMask(false);
  drawFaces(faded, clip, view, part => [...part.color, part.alpha]);
  gl.useProgram(lines.made);
  gl.uniformMatrix4fv(lines.at.clip, false, clip);
  gl.uniform2f(lines.at.size, canvas.width, canvas.height);
  for (const part of solid) drawLines(part.edges, model(part.body), [0.05, 0.06, 0.08, 0.8], 1.1);
  for (const part of faded) drawLines(part.edges, model(part.body), dark ? [0.9, 0.92, 0.95, part.alpha] : [0.05, 0.06, 0.08, part.alpha], 1.1);
  drawPaths(dark, paper);
  drawMarks(paper);
  gl.depthMask(true);
}

function drawPaths(dark, paper) {
  const still = model({ poses: null }), shade = color => color.map(c => dark ? 0.75 * c + 0.25 : 0.75 * c);
  const seen = paths.filter(path => path.shown);
  gl.depthFunc(gl.GREATER);  // what parts hide shines through; the stencil keeps overlapping ends of lines from adding up
  gl.enable(gl.STENCIL_TEST);
  gl.stencilFunc(gl.EQUAL, 0, 255);
  gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
  for (const path of seen) drawLines(path.lines, still, [...shade(path.color), path.through ?? 0.35], path.width ?? 2, 0);
  gl.disable(gl.STENCIL_TEST);
  gl.depthFunc(gl.LEQUAL);
  for (const path of seen) drawLines(path.lines, still, [...shade(path.color), 1], path.width ?? 2, 0);
  gl.disable(gl.DEPTH_TEST);
  for (const path of seen) {
    const point = path.points.subarray(3 * pose, 3 * pose + 3);
    if (!point.every(Number.isFinite)) continue;
    const there = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, ...point, 1];
    drawLines(dot, there, [...paper.slice(0, 3), 1], 11);
    drawLines(dot, there, [...shade(path.color), 1], 7);
  }
}

function drawMarks(paper) {  // where the faces of a lost contact were on each other: a ring on either part
  gl.disable(gl.DEPTH_TEST);
  for (const points of marks.flat()) {
    const point = points.subarray(3 * pose, 3 * pose + 3);
    if (!point.every(Number.isFinite)) continue;
    const there = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, ...point, 1];
    drawLines(dot, there, [...paper.slice(0, 3), 1], 20);
    drawLines(dot, there, WARNING, 17);
    drawLines(dot, there, [...paper.slice(0, 3), 1], 11);
    drawLines(dot, there, WARNING, 6);
  }
}

function partAt(x, y) {  // index of the part at a place of the canvas, in pixels of the page; -1 where there is none
  const canvas = $("canvas"), size = [canvas.width, canvas.height], found = new Uint8Array(4);
  const target = gl.createFramebuffer(), colors = gl.createRenderbuffer(), depths = gl.createRenderbuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, target);
  for (const [buffer, format, place] of [[colors, gl.RGBA8, gl.COLOR_ATTACHMENT0], [depths, gl.DEPTH_COMPONENT16, gl.DEPTH_ATTACHMENT]]) {
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorage(gl.RENDERBUFFER, format, ...size);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
  }
  const { clip, view } = camera(size[0] / size[1]);
  const number = part => [1, 256, 65536].map(step => Math.floor((parts.indexOf(part) + 1) / step) % 256 / 255).concat(1);
  gl.viewport(0, 0, ...size);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.disable(gl.BLEND);
  for (const set of drawnParts().reverse()) {  // solid parts over what they are seen through
    gl.clear(gl.DEPTH_BUFFER_BIT);
    drawFaces(set, clip, view, number, true);
  }
  gl.readPixels(Math.floor(x * devicePixelRatio), size[1] - 1 - Math.floor(y * devicePixelRatio), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, found);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  gl.deleteFramebuffer(target);
  for (const buffer of [colors, depths]) gl.deleteRenderbuffer(buffer);
  redraw();
  return found[0] + 256 * found[1] + 65536 * found[2] - 1;
}

function redraw() {
  if (!waiting) requestAnimationFrame(draw);
  waiting = true;
}
