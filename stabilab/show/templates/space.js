"use strict";
// The space of the rates on a canvas: show(data) draws what it is given in place of what was there; onpick(place, words) hears of a click on something drawn.
// glass: how opaque the surfaces are, so that a motion behind them is seen; near: how near one stands at first; shape: height by width, on a telephone and elsewhere.
function spaceView(canvas, {glass = 1, near = 1, shape = [0.95, 0.7]} = {}) {
  let data = null;
  const view = {show, draw, onpick: null};
  const layer = document.createElement("canvas"), gl = layer.getContext("webgl2", {antialias: true, preserveDrawingBuffer: true}), pen = canvas.getContext("2d");
  const numbers = row => typeof row === "string" ? new Int16Array(Uint8Array.from(atob(row), c => c.charCodeAt(0)).buffer) : row;
  const places = row => Float32Array.from(numbers(row), v => v / 4095);
  const rgb = hex => [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16) / 255);
  if (!gl) { pen.font = "24px sans-serif"; pen.fillText("This browser draws no WebGL 2.", 40, 60); return {...view, show() {}, draw() {}}; }

  const build = (kind, source) => { const s = gl.createShader(kind); gl.shaderSource(s, source); gl.compileShader(s); return s; };
  const program = gl.createProgram();
  gl.attachShader(program, build(gl.VERTEX_SHADER, `#version 300 es
    in vec3 at; in vec3 normal; uniform mat4 view; out vec3 place; out vec3 up;
    void main() { place = at; up = normal; gl_Position = view * vec4(at, 1.0); }`));
  gl.attachShader(program, build(gl.FRAGMENT_SHADER, `#version 300 es
    precision highp float; in vec3 place; in vec3 up; uniform vec3 colour; uniform vec3 eye; uniform float flatly; uniform float glass; out vec4 pixel;
    void main() {
      if (any(greaterThan(abs(place), vec3(1.0005)))) discard;
      vec3 n = normalize(up), e = normalize(eye);
      float light = mix(0.45 + 0.55 * abs(dot(n, normalize(e + vec3(0.25, 0.1, 0.5)))), 1.0, flatly);
      pixel = vec4(colour * light, glass); }`));
  gl.linkProgram(program); gl.useProgram(program);
  const uniforms = {}, where = name => uniforms[name] ??= gl.getUniformLocation(program, name);
  let parts = [], buffers = [], shapes = [], first = null, now = {turn: 0, lift: 0, near};
  const filled = (target, values) => { const buffer = gl.createBuffer(); buffers.push(buffer); gl.bindBuffer(target, buffer); gl.bufferData(target, values, gl.STATIC_DRAW); };

  function add(points, triangles, colour, flatly, wall = null, sheer = null) {  // wall: [axis, side], drawn where that is behind; sheer: what a veil hides
    const normals = new Float32Array(points.length);
    for (let i = 0; i < triangles.length; i += 3) {
      const [a, b, c] = [0, 1, 2].map(k => 3 * triangles[i + k]), u = [0, 1, 2].map(k => points[b + k] - points[a + k]), v = [0, 1, 2].map(k => points[c + k] - points[a + k]);
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      for (const at of [a, b, c]) for (let k = 0; k < 3; k++) normals[at + k] += n[k];
    }
    const vertices = gl.createVertexArray(); gl.bindVertexArray(vertices);
    for (const [name, values] of [["at", points], ["normal", normals]]) {
      const place = gl.getAttribLocation(program, name);
      filled(gl.ARRAY_BUFFER, values);
      if (place >= 0) { gl.enableVertexAttribArray(place); gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 0, 0); }
    }
    filled(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(triangles));
    parts.push({vertices, count: triangles.length, colour: rgb(colour), flatly, wall, sheer});
  }

  function branch({at, rows, columns, colour}, sheer = null) {
    const triangles = [];
    for (let r = 0; r + 1 < rows; r++) for (let c = 0; c + 1 < columns; c++) {
      const a = r * columns + c, b = a + columns;
      triangles.push(a, b, a + 1, a + 1, b, b + 1);
    }
    add(places(at), triangles, colour, 0, null, sheer);
  }

  function tube(points, radius, colour, wall = null, sides = 6) {
    const ring = [], triangles = [], count = points.length / 3;
    for (let i = 0; i < count; i++) {
      const p = k => [0, 1, 2].map(j => points[3 * Math.min(Math.max(k, 0), count - 1) + j]), a = p(i - 1), b = p(i + 1);
      let t = [0, 1, 2].map(j => b[j] - a[j]); const size = Math.hypot(...t) || 1; t = t.map(v => v / size);
      const least = t.map(Math.abs).indexOf(Math.min(...t.map(Math.abs))), e = [0, 1, 2].map(j => +(j === least));
      const cross = (x, y) => [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
      let u = cross(t, e); const us = Math.hypot(...u) || 1; u = u.map(v => v / us); const w = cross(t, u);
      for (let s = 0; s < sides; s++) for (let j = 0; j < 3; j++)
        ring.push(points[3 * i + j] + (radius[i] ?? radius) * (Math.cos(2 * Math.PI * s / sides) * u[j] + Math.sin(2 * Math.PI * s / sides) * w[j]));
      if (i) for (let s = 0; s < sides; s++) {
        const x = (i - 1) * sides + s, y = (i - 1) * sides + (s + 1) % sides;
        triangles.push(x, y, x + sides, y, y + sides, x + sides);
      }
    }
    if (count > 1) add(new Float32Array(ring), triangles, colour, wall ? 1 : 0.25, wall);
  }

  function shadows(points) {  // of a path on each wall of the box
    for (const axis of [0, 1, 2]) for (const side of [-1, 1]) tube(points.map((v, i) => i % 3 === axis ? 0.999 * side : v), 0.005, "#BDBDBD", [axis, side], 3);
  }

  const arrow = (at, step, colour) => tube([-0.4, 0.6].flatMap(share => at.map((v, j) => v + share * step[j])), [0.5 * Math.hypot(...step), 0], colour, null, 12);

  function ball([x, y, z], radius, colour) {
    const n = 10, m = 16, points = [], triangles = [];
    for (let i = 0; i <= n; i++) for (let j = 0; j <= m; j++) {
      const a = Math.PI * i / n, b = 2 * Math.PI * j / m;
      points.push(x + radius * Math.sin(a) * Math.cos(b), y + radius * Math.sin(a) * Math.sin(b), z + radius * Math.cos(a));
      if (i < n && j < m) { const k = i * (m + 1) + j; triangles.push(k, k + 1, k + m + 1, k + 1, k + m + 2, k + m + 1); }
    }
    add(new Float32Array(points), triangles, colour, 0.2);
  }

  const corner = [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]];
  const edges = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
  function show(given) {
    data = given;
    if (!first) { first = {turn: data.view[1] * Math.PI / 180, lift: data.view[0] * Math.PI / 180, near}; now = {...first}; }
    parts.forEach(part => gl.deleteVertexArray(part.vertices)); buffers.forEach(buffer => gl.deleteBuffer(buffer));
    parts = []; buffers = []; shapes = [];
    data.branches.forEach(one => branch(one));
    data.veils.forEach(one => branch(one, one.name.includes("limit") ? 0.16 : 0.4));
    const wide = (kind, at) => kind !== "this motion" ? 0.011 : at.length > 6000 ? 0.006 : 0.013;  // thin of a motion that turns often
    data.curves.forEach(c => { const at = places(c.at); tube(at, wide(c.kind, at), c.colour); });
    data.points.forEach(p => { ball(p.at, 0.03, p.colour); tube([...p.at, ...p.at.slice(0, 2), -0.999], 0.003, "#7A7A7A"); });
    for (const motion of data.curves.filter(c => c.kind === "this motion")) {
      shadows(places(motion.at));
    }
    data.arrows.forEach(([at, step]) => arrow(at, step, data.curves.find(c => c.kind === "this motion").colour));
    edges.forEach(([a, b]) => tube([...corner[a], ...corner[b]], 0.0025, "#999999"));
    shapes = [...data.points.map(p => [p.kind, [p.at]]), ...[...data.curves, ...data.branches].map(c => [c.kind || c.name, c.at])];
    draw();
  }

  const rim = 0.88;  // of half the box: up to here numbers stand, the corners are crowded
  function step(half, middle) {  // the largest round number of which an axis shows three multiples
    const ten = 10 ** Math.floor(Math.log10(half)), shown = every => Math.floor((middle + rim * half) / every) - Math.ceil((middle - rim * half) / every) + 1;
    return ten * [10, 5, 2, 1, 0.5, 0.2].find(k => shown(k * ten) >= 3);
  }
  function look() {
    const {turn, lift, near} = now, ct = Math.cos(turn), st = Math.sin(turn), cl = Math.cos(lift), sl = Math.sin(lift);
    const right = [-st, ct, 0], up = [-sl * ct, -sl * st, cl], eye = [cl * ct, cl * st, sl], away = 9;
    const across = 5.2 * near, ratio = canvas.width / canvas.height, wide = Math.min(1, ratio / 1.15);
    return {eye, of: p => {
      const dot = v => v[0] * p[0] + v[1] * p[1] + v[2] * p[2], w = away - dot(eye);
      return [across * wide * dot(right) / ratio, across * wide * dot(up), 0, w];
    }, matrix: (() => {
      const a = across * wide / ratio, b = across * wide;
      return new Float32Array([0, 1, 2].flatMap(k => [a * right[k], b * up[k], -1.2 * eye[k], -eye[k]]).concat([0, 0, 0, away]));
    })()};
  }
  function draw() {
    if (!data) return;
    const sharp = Math.min(window.devicePixelRatio || 1, 2), width = Math.round(canvas.clientWidth * sharp) || 1000, height = Math.round(width * (shape[canvas.clientWidth < 420 ? 0 : 1]));
    if (canvas.width !== width || canvas.height !== height) { canvas.width = layer.width = width; canvas.height = layer.height = height; }
    const seen = look();
    gl.viewport(0, 0, width, height); gl.clearColor(1, 1, 1, 1); gl.enable(gl.DEPTH_TEST); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(where("view"), false, seen.matrix); gl.uniform3fv(where("eye"), seen.eye);
    gl.enable(gl.BLEND); gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE);
    for (const part of [...parts.filter(one => one.flatly), ...parts.filter(one => !one.flatly && !one.sheer), ...parts.filter(one => one.sheer).sort((a, b) => b.sheer - a.sheer)].filter(({wall}) => !wall || wall[1] * seen.eye[wall[0]] < 0)) {
      const clear = glass < 1 && !part.flatly;  // a surface: after all else, and hiding nothing behind it
      gl.depthMask(!clear && !part.sheer); gl.uniform1f(where("glass"), part.sheer || (clear ? glass : 1));
      gl.uniform3fv(where("colour"), part.colour); gl.uniform1f(where("flatly"), part.flatly); gl.bindVertexArray(part.vertices);
      if (part.sheer) {  // its nearest layer alone
        gl.depthMask(true); gl.colorMask(false, false, false, false); gl.drawElements(gl.TRIANGLES, part.count, gl.UNSIGNED_INT, 0);
        gl.colorMask(true, true, true, true); gl.depthFunc(gl.LEQUAL);
      }
      gl.drawElements(gl.TRIANGLES, part.count, gl.UNSIGNED_INT, 0); gl.depthFunc(gl.LESS);
    }
    gl.depthMask(true);
    pen.drawImage(layer, 0, 0); words(seen, sharp);
  }
  function words(seen, sharp) {
    const small = 13 * sharp, at = p => { const [x, y, , w] = seen.of(p); return [canvas.width * (0.5 + x / w / 2), canvas.height * (0.5 - y / w / 2)]; };
    pen.textAlign = "center"; pen.textBaseline = "middle";
    const middle = at([0, 0, 0]);
    for (const [place, told] of data.times) {  // on the side of its turn that is away from the middle
      const [x, y] = at(place), right = x >= middle[0], wide = (pen.font = `${small}px sans-serif`, pen.measureText(told).width);
      const left = Math.min(Math.max(right ? x + 8 * sharp : x - 8 * sharp - wide, 2), canvas.width - wide - 2);
      pen.lineWidth = 3 * sharp; pen.strokeStyle = "#fff"; pen.strokeText(told, left + wide / 2, y); pen.fillStyle = "#000"; pen.fillText(told, left + wide / 2, y);
    }
    for (let k = 0; k < 3; k++) {  // along each axis the edge of the box that is seen outermost
      const others = [0, 1, 2].filter(j => j !== k), edges = [[-1, -1], [-1, 1], [1, -1], [1, 1]].map(([a, b]) => s => { const p = [0, 0, 0]; p[k] = s; p[others[0]] = a; p[others[1]] = b; return p; });
      const out = e => { const [x, y] = at(e(0)); return k === 2 ? -x : y + 0.25 * Math.abs(x - middle[0]); };
      const edge = edges.reduce((a, b) => out(b) > out(a) ? b : a), [mx, my] = at(edge(0));
      const ends = [at(edge(-1)), at(edge(1))], [ex, ey] = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]], size = Math.hypot(ex, ey) || 1;
      const side = Math.sign(-ey * (mx - middle[0]) + ex * (my - middle[1])) || 1, away = [-side * ey / size, side * ex / size];  // across the edge, outwards
      const half = data.half[k], every = step(half, data.middle[k]), low = data.middle[k] - half, high = data.middle[k] + half;
      const far = Math.max(Math.abs(low), Math.abs(high)) / every, ten = 10 ** Math.ceil(Math.log10(2 * rim * half));
      const base = far < 5e3 ? 0 : Math.round(data.middle[k] / ten) * ten;  // neighbours that differ in their last digits stand as differences from it
      const name = base ? data.names[k].replace(/( \(|$)/, ` ${base > 0 ? "\u2212" : "+"} ${+Math.abs(base).toPrecision(12)}$1`) : data.names[k];
      const inside = (x, room) => Math.min(Math.max(x, room), canvas.width - room);
      pen.fillStyle = "#333"; pen.font = `${small}px sans-serif`; let widest = 0;
      for (let v = Math.ceil(low / every) * every; v <= high; v += every) {
        if (Math.abs(v - data.middle[k]) > rim * half) continue;
        const [x, y] = at(edge((v - data.middle[k]) / half));
        const told = String(+(Math.round((v - base) / every) * every).toPrecision(6) || 0).replace("-", "\u2212"), wide = pen.measureText(told).width;
        widest = Math.max(widest, wide);
        pen.fillText(told, inside(x + (8 * sharp + wide / 2) * away[0], wide / 2 + 2), y + 16 * sharp * away[1]);
      }
      pen.fillStyle = "#000"; pen.font = `600 ${small * 1.1}px sans-serif`;
      const room = pen.measureText(name).width / 2 + 4;
      let [tx, ty] = [mx + (18 * sharp + widest + room) * away[0], my + 44 * sharp * away[1]];
      if (tx < room || tx > canvas.width - room) {  // no room beside the numbers: beyond the upper end of the edge
        const end = ends[0][1] < ends[1][1] ? ends[0] : ends[1];
        [tx, ty] = [end[0] + room * 0.5 * away[0], end[1] - 16 * sharp];
      }
      pen.fillText(name, inside(tx, room), Math.min(Math.max(ty, small), canvas.height - small));
    }
  }
  const held = new Map(); let apart = 0;
  let pressed = null;
  canvas.addEventListener("pointerdown", e => { pressed = e; held.set(e.pointerId, e); canvas.setPointerCapture(e.pointerId); apart = 0; });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, e => { held.delete(e.pointerId); apart = 0; });
  canvas.addEventListener("pointerup", e => { if (view.onpick && data && pressed && Math.hypot(e.clientX - pressed.clientX, e.clientY - pressed.clientY) < 5) pick(e.offsetX, e.offsetY); });
  function pick(x, y) {  // the nearest place within some pixels; of two as near the one in front
    const seen = look(), wide = canvas.clientWidth, high = canvas.clientHeight; let best = null, words = "";
    for (const [name, row] of shapes) {
      const points = Array.isArray(row) ? row : Array.from(places(row)).reduce((all, v, i) => { if (i % 3) all[all.length - 1].push(v); else all.push([v]); return all; }, []);
      for (const p of points) {
        if (p.some(v => Math.abs(v) > 1)) continue;
        const [a, b, , w] = seen.of(p), off = Math.hypot(wide * (0.5 + a / w / 2) - x, high * (0.5 - b / w / 2) - y), cost = off + 12 * w + (name.startsWith("Branch") ? 8 : 0);
        if (off < 14 && (!best || cost < best.cost)) { best = {cost, p}; words = name; }
      }
    }
    if (best) view.onpick(best.p.map((v, k) => data.middle[k] + data.half[k] * v), words);
  }
  canvas.addEventListener("keydown", e => {
    const way = {ArrowLeft: [0.12, 0, 1], ArrowRight: [-0.12, 0, 1], ArrowUp: [0, -0.12, 1], ArrowDown: [0, 0.12, 1], "+": [0, 0, 1.15], "=": [0, 0, 1.15], "-": [0, 0, 1 / 1.15]}[e.key];
    if (!way) return;
    e.preventDefault(); now.turn += way[0]; now.lift = Math.min(1.55, Math.max(-1.55, now.lift + way[1])); now.near = Math.min(8, Math.max(0.4, now.near * way[2])); draw();
  });
  canvas.addEventListener("pointermove", e => {
    const before = held.get(e.pointerId); if (!before) return;
    held.set(e.pointerId, e);
    if (held.size === 2) {
      const [a, b] = [...held.values()], far = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
      if (apart) now.near = Math.min(8, Math.max(0.4, now.near * far / apart)); apart = far;
    } else { now.turn -= (e.clientX - before.clientX) / 180; now.lift = Math.min(1.55, Math.max(-1.55, now.lift + (e.clientY - before.clientY) / 180)); }
    draw();
  });
  canvas.addEventListener("wheel", e => { if (!e.ctrlKey && !held.size && document.activeElement !== canvas) return; e.preventDefault(); now.near = Math.min(8, Math.max(0.4, now.near * Math.exp(-e.deltaY / 500))); draw(); }, {passive: false});
  canvas.tabIndex = 0; canvas.addEventListener("dblclick", () => { if (first) now = {...first}; draw(); });
  window.addEventListener("resize", draw);
  return view;
}
