// The stage: boxes with a light, a shadow and a camera that orbits, in WebGL 2. x across the stairs, y up the stairs, z up.

const VERTEX = `#version 300 es
layout(location = 0) in vec3 at; layout(location = 1) in vec3 normal;
uniform mat4 model, camera, light; out vec3 world, facing; out vec4 inLight;
void main() { vec4 place = model * vec4(at, 1.0); world = place.xyz; facing = mat3(model) * normal; inLight = light * place; gl_Position = camera * place; }`;
const FRAGMENT = `#version 300 es
precision highp float; precision highp sampler2DShadow;
in vec3 world, facing; in vec4 inLight; out vec4 result;
uniform vec4 colour; uniform vec3 eye, sun, fog; uniform float grid; uniform sampler2DShadow shadow;
float lit() {
  vec3 at = inLight.xyz / inLight.w * 0.5 + 0.5;
  if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
  float sum = 0.0; vec2 texel = 1.0 / vec2(textureSize(shadow, 0));
  for (int x = -1; x <= 1; x++) for (int y = -1; y <= 1; y++) sum += texture(shadow, vec3(at.xy + vec2(x, y) * texel, at.z - 0.0015));
  return sum / 9.0;
}
void main() {
  vec3 normal = normalize(facing);
  float direct = max(dot(normal, sun), 0.0) * lit();
  vec3 base = colour.rgb;
  if (grid > 0.0) {
    vec2 near = abs(fract(world.xy - 0.5) - 0.5) / max(fwidth(world.xy), vec2(1e-4));
    base = mix(base, base * 0.88, grid * (1.0 - min(min(near.x, near.y), 1.0)));
  }
  float above = 0.5 + 0.5 * normal.z;
  vec3 shade = base * (0.42 + 0.16 * above) + base * direct * 0.55;
  vec3 view = normalize(eye - world);
  shade += vec3(0.10) * pow(max(dot(normal, normalize(view + sun)), 0.0), 40.0) * direct * (1.0 - grid);
  float far = smoothstep(35.0, 110.0, distance(eye, world));
  result = vec4(mix(shade, fog, far), colour.a);
}`;
const SHADOW_FRAGMENT = `#version 300 es
precision mediump float; void main() {}`;
const SHADOW_SIZE = 2048;
const SUN = normalized([0.45, -0.55, 0.95]);
const COLOURS = {
  light: { red: [0.86, 0.13, 0.12], blue: [0.10, 0.27, 0.84], stair: [0.81, 0.80, 0.78], edge: [0.60, 0.57, 0.52], ground: [0.73, 0.78, 0.78], sky: [0.89, 0.93, 0.96], white: [0.97, 0.96, 0.93], metal: [0.16, 0.17, 0.20] },
  dark: { red: [0.88, 0.14, 0.14], blue: [0.14, 0.32, 0.95], stair: [0.42, 0.43, 0.46], edge: [0.62, 0.63, 0.66], ground: [0.20, 0.22, 0.26], sky: [0.10, 0.12, 0.16], white: [0.93, 0.93, 0.90], metal: [0.30, 0.31, 0.35] },
};

function normalized(v) { const length = Math.hypot(...v) || 1; return v.map((part) => part / length); }
function cross(a, b) { return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]; }
function dot(a, b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
function multiplied(a, b) {
  const result = new Float32Array(16);
  for (let column = 0; column < 4; column++) for (let row = 0; row < 4; row++) {
    let sum = 0;
    for (let k = 0; k < 4; k++) sum += a[k * 4 + row] * b[column * 4 + k];
    result[column * 4 + row] = sum;
  }
  return result;
}
function lookingAt(eye, target, up) {
  const back = normalized([0, 1, 2].map((i) => eye[i] - target[i]));
  const right = normalized(cross(up, back));
  const top = cross(back, right);
  return new Float32Array([right[0], top[0], back[0], 0, right[1], top[1], back[1], 0, right[2], top[2], back[2], 0, -dot(right, eye), -dot(top, eye), -dot(back, eye), 1]);
}
function perspective(view, aspect, near, far) {
  const f = 1 / Math.tan(view / 2);
  return new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0]);
}
function orthographic(half, near, far) {
  return new Float32Array([1 / half, 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, 2 / (near - far), 0, 0, 0, (far + near) / (near - far), 1]);
}
// The matrix of a pose: position, and rotation as a unit quaternion x, y, z, w; the box is moved by `offset` and scaled first.
function placed(at, q, offset = [0, 0, 0], scale = [1, 1, 1]) {
  const [x, y, z, w] = q;
  const turn = [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)];
  const moved = [0, 1, 2].map((i) => at[i] + turn[i] * offset[0] + turn[3 + i] * offset[1] + turn[6 + i] * offset[2]);
  return new Float32Array([turn[0] * scale[0], turn[1] * scale[0], turn[2] * scale[0], 0, turn[3] * scale[1], turn[4] * scale[1], turn[5] * scale[1], 0, turn[6] * scale[2], turn[7] * scale[2], turn[8] * scale[2], 0, moved[0], moved[1], moved[2], 1]);
}

// A box with rounded edges: each face is a grid whose points are pressed onto the rounded surface.
function roundedBox(size, radius, parts) {
  const half = size.map((side) => side / 2), inner = half.map((side) => side - radius);
  const points = [], indices = [];
  for (let axis = 0; axis < 3; axis++) for (const sign of [-1, 1]) {
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3], start = points.length / 6;
    // The grid is fine where the edges are round, and one cell wide between them.
    const ticks = (side) => { const list = []; for (let i = 0; i <= parts; i++) list.push(-half[side] + radius * i / parts); for (let i = 0; i <= parts; i++) list.push(inner[side] + radius * i / parts); return list; };
    const [us, vs] = [ticks(u), ticks(v)];
    for (const a of us) for (const b of vs) {
      const at = [0, 0, 0]; at[axis] = sign * half[axis]; at[u] = a; at[v] = b;
      const core = at.map((part, i) => Math.max(-inner[i], Math.min(inner[i], part)));
      const normal = normalized(at.map((part, i) => part - core[i]));
      points.push(...core.map((part, i) => part + normal[i] * radius), ...normal);
    }
    const across = vs.length;
    for (let i = 0; i + 1 < us.length; i++) for (let j = 0; j + 1 < vs.length; j++) {
      const a = start + i * across + j, corners = [a, a + across, a + across + 1, a, a + across + 1, a + 1];
      indices.push(...(sign > 0 ? corners : corners.reverse()));
    }
  }
  return { points, indices };
}

class Scene {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = this.gl = canvas.getContext("webgl2", { antialias: true, alpha: false });
    if (!gl) throw new Error("This browser has no WebGL 2, so the climb is shown as a drawing.");
    this.program = this.compiled(VERTEX, FRAGMENT);
    this.shadowProgram = this.compiled(VERTEX, SHADOW_FRAGMENT);
    this.meshes = new Map();
    this.shadow = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.shadow);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, SHADOW_SIZE, SHADOW_SIZE);
    for (const [name, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR], [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE], [gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE]]) gl.texParameteri(gl.TEXTURE_2D, name, value);
    this.shadowBuffer = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowBuffer);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.shadow, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.enable(gl.DEPTH_TEST); gl.enable(gl.CULL_FACE);
  }

  compiled(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text); gl.compileShader(shader); gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(`The graphics driver refused a shader: ${gl.getProgramInfoLog(program)}`);
    const names = {};
    for (const name of ["model", "camera", "light", "colour", "eye", "sun", "fog", "grid", "shadow"]) names[name] = gl.getUniformLocation(program, name);
    return { program, names };
  }

  mesh(size, radius) {
    const key = [...size, radius].join(" ");
    if (!this.meshes.has(key)) {
      const { points, indices } = roundedBox(size, radius, radius > 0 ? 4 : 1), gl = this.gl, array = gl.createVertexArray();
      gl.bindVertexArray(array);
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer()); gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(points), gl.STATIC_DRAW);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer()); gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint16Array(indices), gl.STATIC_DRAW);
      for (const place of [0, 1]) { gl.enableVertexAttribArray(place); gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 24, place * 12); }
      gl.bindVertexArray(null);
      this.meshes.set(key, { array, count: indices.length });
    }
    return this.meshes.get(key);
  }

  // Everything to draw: solids with a matrix and a colour.
  solids(lanes, colours) {
    const still = [0, 0, 0, 1], list = [];
    const box = (min, max, colour) => list.push({ mesh: this.mesh([1, 1, 1], 0.0001), model: placed(min.map((low, i) => (low + max[i]) / 2), still, [0, 0, 0], max.map((high, i) => high - min[i])), colour });
    for (const lane of lanes) {
      const shift = lane.shift;
      const { stairs, edges, width_m } = lane.champion, half = width_m / 2;
      for (const { at: [x, y, z], size, turn } of stairs) list.push({ mesh: this.mesh([1, 1, 1], 0.0001), model: placed([x + shift, y, z], turn, [0, 0, 0], size), colour: colours.stair });
      for (const [y, z, ahead] of edges) {
        const ends = [y - 0.012 * ahead, y + 0.10 * ahead].sort((a, b) => a - b);
        box([shift - half, ends[0], z - 0.06], [shift + half, ends[1], z + 0.012], colours.edge);
      }
      const { parts, limbs } = lane.champion;
      parts.forEach((size, index) => {
        const { at: [x, y, z], turn } = lane.poses[index], at = [x + shift, y, z], limb = limbs[index];
        // A soft limb has several parts, without gaps between them.
        const isFront = limbs[index - 1] !== limb, isRear = limbs[index + 1] !== limb, last = limbs.at(-1);
        const cuts = [isFront && limb > 0 ? 0.07 : 0, isRear && limb < last ? 0.07 : 0], thick = Math.min(size[0], size[2]);
        const tone = limb % 2 === 0 ? colours.red : colours.blue, colour = lane.pale ? tone.map((part) => part * 0.55 + 0.42) : tone;
        const part = (offset, scale, radius, tint) => list.push({ mesh: this.mesh(scale, radius), model: placed(at, turn, offset), colour: tint });
        part([0, (cuts[1] - cuts[0]) / 2, 0], [size[0], size[1] - cuts[0] - cuts[1], size[2]], Math.min(...size) * 0.2, colour);
        part([0, 0, size[2] / 2], [size[0] * 0.16, size[1] * (isFront && isRear ? 0.74 : 1), 0.02], 0.0001, colours.white);
        if (isFront && limb > 0) part([0, size[1] / 2, 0], [size[0] * 0.86, 0.14, thick * 0.24], 0.05, colours.metal);
        if (index === 0) for (const side of [-1, 1]) {
          part([side * size[0] * 0.3, size[1] * 0.34, size[2] * 0.47], [thick * 0.26, thick * 0.26, thick * 0.26], thick * 0.13, colours.white);
          part([side * size[0] * 0.32, size[1] * 0.40, size[2] * 0.50], [thick * 0.14, thick * 0.14, thick * 0.14], thick * 0.07, colours.metal);
        }
      });
    }
    return list;
  }

  // Draws the lanes; returns where each head appears, in pixels of the page.
  draw(lanes, orbit, theme) {
    const gl = this.gl, colours = COLOURS[theme], scale = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(this.canvas.clientWidth * scale)), height = Math.max(1, Math.round(this.canvas.clientHeight * scale));
    if (this.canvas.width !== width || this.canvas.height !== height) { this.canvas.width = width; this.canvas.height = height; }
    const aspect = width / height, { target } = orbit;
    // A narrow picture sees the snake from further away.
    const distance = orbit.distance * Math.max(1, 1.25 / aspect);
    const level = Math.cos(orbit.pitch), away = [Math.cos(orbit.yaw) * level, Math.sin(orbit.yaw) * level, Math.sin(orbit.pitch)];
    const eye = target.map((part, i) => part + away[i] * distance);
    const camera = multiplied(perspective(Math.PI / 4, aspect, 0.1, 400), lookingAt(eye, target, [0, 0, 1]));
    const reach = Math.max(14, distance * 0.9);
    const light = multiplied(orthographic(reach, 1, 160), lookingAt(target.map((part, i) => part + SUN[i] * 80), target, [0, 1, 0]));
    const solids = this.solids(lanes, colours);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowBuffer);
    gl.viewport(0, 0, SHADOW_SIZE, SHADOW_SIZE); gl.clear(gl.DEPTH_BUFFER_BIT);
    this.pass(this.shadowProgram, solids, { camera: light, light });
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.clearColor(...colours.sky, 1); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const ground = { mesh: this.mesh([1, 1, 1], 0.0001), model: placed([Math.round(target[0]), Math.round(target[1]), -0.5], [0, 0, 0, 1], [0, 0, 0], [400, 400, 1]), colour: colours.ground, grid: 1 };
    gl.bindTexture(gl.TEXTURE_2D, this.shadow);
    this.pass(this.program, [ground, ...solids], { camera, light, eye, fog: colours.sky });
    return lanes.map((lane) => {
      const [x, y, z] = lane.poses[0].at, point = [x + lane.shift, y, z + 1.1, 1];
      const clip = [0, 1, 3].map((row) => [0, 1, 2, 3].reduce((sum, k) => sum + camera[k * 4 + row] * point[k], 0));
      return clip[2] <= 0 ? null : [(clip[0] / clip[2] + 1) / 2, (1 - clip[1] / clip[2]) / 2];
    });
  }

  pass({ program, names }, solids, { camera, light, eye, fog }) {
    const gl = this.gl;
    gl.useProgram(program);
    gl.uniformMatrix4fv(names.camera, false, camera); gl.uniformMatrix4fv(names.light, false, light);
    if (eye) { gl.uniform3fv(names.eye, eye); gl.uniform3fv(names.sun, SUN); gl.uniform3fv(names.fog, fog); gl.uniform1i(names.shadow, 0); }
    for (const { mesh, model, colour, grid } of solids) {
      gl.uniformMatrix4fv(names.model, false, model);
      if (eye) { gl.uniform4f(names.colour, ...colour, 1); gl.uniform1f(names.grid, grid || 0); }
      gl.bindVertexArray(mesh.array);
      gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_SHORT, 0);
    }
  }
}
