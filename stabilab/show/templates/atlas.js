"use strict";
// An atlas on a canvas: the sheet (Hammer's map) or a globe to be turned. Each pixel is asked for its direction, the direction for its cell; so a pointer is.
function atlasView(canvas, data, say) {
  const pen = canvas.getContext("2d"), ROOT2 = Math.SQRT2, COS_G = Math.sqrt(2 / 3), TAN_G = Math.sqrt(1 / 2), PART = Math.PI / 12;
  const state = {wheel: 0, kind: "fate", globe: false, turn: [0.6, 0.45], at: null};

  // the place on the octahedron of a direction, as maps/pointed.py has it
  function placeOf(d) {
    const size = Math.hypot(...d), u = d.map(v => Math.abs(v) / size);
    let k = 0; for (const n of [1, 2]) if (u[n] < u[k]) k = n;
    const i = (k + 1) % 3, j = (k + 2) % 3, side = (u[i] + u[j] - 2 * u[k]) / Math.sqrt(6), edge = (u[i] - u[j]) / ROOT2;
    const azimuth = Math.atan2(edge, side), z = Math.atan2(Math.hypot(side, edge), (u[0] + u[1] + u[2]) / Math.sqrt(3));
    const r = Math.min(Math.sin(z / 2) / Math.sin(Math.atan2(TAN_G, Math.cos(azimuth)) / 2), 1);
    const t = (azimuth + Math.acos(Math.max(-1, Math.min(1, Math.sin(azimuth) * COS_G))) - Math.PI / 2) / PART, place = [0, 0, 0];
    place[k] = (1 - r) / 3; place[i] = place[k] + r * (1 + t) / 2; place[j] = place[k] + r * (1 - t) / 2;
    return place;
  }
  // the cell that holds a direction: its number at the greatest depth, then the last cell that begins no later
  function cellOf(d, wheel) {
    let number = (d[0] < 0) + 2 * (d[1] < 0) + 4 * (d[2] < 0), share = placeOf(d);
    for (let n = 0; n < data.deepest; n++) {
      const corner = share.findIndex(v => v > 0.5);
      share = corner < 0 ? share.map(v => 1 - 2 * v) : share.map((v, at) => 2 * v - (at === corner));
      number = 4 * number + (corner < 0 ? 3 : corner);
    }
    const begin = data.wheels[wheel].begin; let low = 0, high = begin.length;
    while (high - low > 1) { const middle = low + high >> 1; if (begin[middle] <= number) low = middle; else high = middle; }
    return low;
  }
  const turned = d => { // as the globe shows it: x right, y up, z to the eye
    const [c, s, C, S] = [Math.cos(state.turn[0]), Math.sin(state.turn[0]), Math.cos(state.turn[1]), Math.sin(state.turn[1])];
    const x = -s * d[0] + c * d[1], y = c * d[0] + s * d[1];
    return [x, C * d[2] - S * y, C * y + S * d[2]];
  };
  const back = ([x, y, z]) => {
    const [c, s, C, S] = [Math.cos(state.turn[0]), Math.sin(state.turn[0]), Math.cos(state.turn[1]), Math.sin(state.turn[1])];
    const w = C * z - S * y;
    return [c * w - s * x, s * w + c * x, C * y + S * z];
  };
  const width = () => canvas.width, height = () => canvas.height;
  const radius = () => 0.46 * height();
  function directionAt(px, py) {
    if (state.globe) {
      const x = (px - width() / 2) / radius(), y = (height() / 2 - py) / radius(), rest = 1 - x * x - y * y;
      return rest < 0 ? null : back([x, y, Math.sqrt(rest)]);
    }
    const x = (px / width() * 2 - 1) * 2.08 * ROOT2, y = (1 - py / height() * 2) * 1.1 * ROOT2;
    if (x * x / 8 + y * y / 2 > 1) return null;
    const root = Math.sqrt(1 - x * x / 16 - y * y / 4), turn = 2 * Math.atan2(root * x, 2 * (2 * root * root - 1)) + Math.PI / 4;
    const sine = Math.max(-1, Math.min(1, root * y)), cosine = Math.sqrt(1 - sine * sine);
    return [cosine * Math.cos(turn), cosine * Math.sin(turn), sine];
  }
  function pixelOf(d) {
    if (state.globe) { const [x, y, z] = turned(d); return z < 0 ? null : [width() / 2 + radius() * x, height() / 2 - radius() * y]; }
    let turn = Math.atan2(d[1], d[0]) - Math.PI / 4; turn -= 2 * Math.PI * Math.floor((turn + Math.PI) / (2 * Math.PI));
    const cosine = Math.hypot(d[0], d[1]), root = Math.sqrt(1 + cosine * Math.cos(turn / 2));
    const x = 2 * ROOT2 * cosine * Math.sin(turn / 2) / root, y = ROOT2 * d[2] / root;
    return [(x / (2.08 * ROOT2) + 1) / 2 * width(), (1 - y / (1.1 * ROOT2)) / 2 * height()];
  }

  let drag = null, waiting = false, held = null; // cells of the pixels of the sheet, which change with the wheel alone
  function cells() {
    if (!state.globe && held && held.wheel === state.wheel) return held.rows;
    const rows = new Int32Array(width() * height()).fill(-1);
    const step = drag ? 3 : 1; // coarser while a hand turns it
    for (let py = 0; py < height(); py += step) for (let px = 0; px < width(); px += step) {
      const d = directionAt(px + step / 2, py + step / 2), cell = d ? cellOf(d, state.wheel) : -1;
      for (let y = py; y < Math.min(py + step, height()); y++) rows.fill(cell, y * width() + px, y * width() + Math.min(px + step, width()));
    }
    if (!state.globe) held = {wheel: state.wheel, rows};
    return rows;
  }
  function draw() {
    const rows = cells(), image = pen.createImageData(width(), height()), of = data.wheels[state.wheel].columns[state.kind], table = data.kinds[state.kind].colours;
    const hatches = data.kinds[state.kind].hatches || [], wide = width(), k = Math.round(large()), far = 9 * k;
    const inked = {"/": (x, y) => (x + y) % far < k, "\\": (x, y) => (x - y % far + far) % far < k, "|": x => x % far < k,  // the axis of a spin-up
      ".": (x, y) => x % far < 2 * k && y % far < 2 * k, "o": (x, y) => x % far < 3 * k && y % far < 3 * k, "O": (x, y) => x % far < 5 * k && y % far < 5 * k};
    for (let n = 0; n < rows.length; n++) if (rows[n] >= 0) {
      const kind = of[rows[n]], ink = inked[hatches[kind]], dark = ink && ink(n % wide, Math.floor(n / wide)) ? 0.4 : 1;
      const [r, g, b] = table[kind].map(v => dark * v);
      image.data.set([r, g, b, 255], 4 * n);
    }
    pen.putImageData(image, 0, 0);
    lines(); points();
    if (state.at) { const at = pixelOf(state.at); if (at) { pen.strokeStyle = "#000"; const k = large(); pen.lineWidth = 1.5 * k; pen.strokeRect(at[0] - 5 * k, at[1] - 5 * k, 10 * k, 10 * k); } }
  }
  function lines() {
    pen.strokeStyle = "rgba(0,0,0,.45)"; pen.lineWidth = 1;
    for (let axis = 0; axis < 3; axis++) {
      let last = null; pen.beginPath();
      for (let n = 0; n <= 360; n++) {
        const d = [0, 0, 0], turn = n * Math.PI / 180; d[(axis + 1) % 3] = Math.cos(turn); d[(axis + 2) % 3] = Math.sin(turn);
        const at = pixelOf(d);
        if (at && last && Math.abs(at[0] - last[0]) < width() / 3) pen.lineTo(...at); else if (at) pen.moveTo(...at);
        last = at;
      }
      pen.stroke();
    }
    pen.strokeStyle = "#000"; pen.lineWidth = 1.5; pen.beginPath();
    if (state.globe) pen.arc(width() / 2, height() / 2, radius(), 0, 7); else pen.ellipse(width() / 2, height() / 2, width() / 2.08, height() / 2.2, 0, 0, 7);
    pen.stroke();
  }
  const large = () => Math.min(4, Math.max(1, 0.85 * width() / (canvas.clientWidth || width()))); // signs keep their size where the page shows the canvas small
  const named = () => data.named.filter(one => one.wheel === state.wheel);
  function points() {
    const k = large();
    pen.font = `bold ${15 * k}px sans-serif`; pen.lineJoin = "round";
    const taken = [];  // boxes of names: two directions may be one, or beside each other
    for (const one of named()) {
      const at = pixelOf(one.direction);
      if (!at) continue;
      pen.beginPath(); pen.arc(...at, k * (one.axis ? 4.5 : 6.5), 0, 7); pen.fillStyle = one.axis ? "#fff" : "#000"; pen.fill();
      pen.strokeStyle = "#000"; pen.lineWidth = 1.3 * k; pen.stroke();
      const right = at[0] < 0.86 * width(), wide = pen.measureText(one.name).width;
      const boxes = [[right, -6 * k], [right, 18 * k], [!right, -6 * k], [!right, 18 * k]].map(([side, down]) => {
        const left = at[0] + (side ? 9 * k : -9 * k - wide), y = Math.max(at[1] + down, 14 * k); // within the picture
        return {side, x: at[0] + k * (side ? 9 : -9), y, box: [left, left + wide, y - 13 * k, y + 3 * k]};
      });
      const free = box => !taken.some(other => box[0] < other[1] && other[0] < box[1] && box[2] < other[3] && other[2] < box[3]);
      const chosen = boxes.find(place => free(place.box)) || boxes[0];
      taken.push(chosen.box);
      pen.textAlign = chosen.side ? "left" : "right"; pen.lineWidth = 3 * k; pen.strokeStyle = "#fff";
      pen.strokeText(one.name, chosen.x, chosen.y); pen.fillStyle = "#000"; pen.fillText(one.name, chosen.x, chosen.y);
    }
  }

  const three = d => "(" + d.map(v => Math.abs(v) < 5e-4 ? "0" : v.toPrecision(3).replace("-", "\u2212")).join(", ") + ")";
  const inFile = d => data.axes ? [0, 1, 2].map(n => d[0] * data.axes[0][n] + d[1] * data.axes[1][n] + d[2] * data.axes[2][n]) : d;
  function words(d) {
    const near = named().find(one => one.direction[0] * d[0] + one.direction[1] * d[1] + one.direction[2] * d[2] > 1 - 2e-4);
    if (near) return [`${near.name}, exactly there, direction ${three(inFile(near.direction))}`, ...near.words];
    const row = cellOf(d, state.wheel), of = data.wheels[state.wheel];
    const told = data.order.filter(name => name !== "when").map(name => data.kinds[name].words[of.columns[name][row]]);
    if (of.times) told.splice(1, 0, of.times[row]);
    return [`direction ${three(inFile(d))}`, ...told, `cell of depth ${of.depth[row]}`];
  }
  function show(d) { state.at = d; say(d ? words(d) : null); }
  const place = event => { const r = canvas.getBoundingClientRect(); return [(event.clientX - r.x) / r.width * width(), (event.clientY - r.y) / r.height * height()]; };
  const later = () => { if (!waiting) { waiting = true; requestAnimationFrame(() => { waiting = false; draw(); }); } };
  canvas.addEventListener("pointerdown", event => {
    const d = directionAt(...place(event));
    if (event.pointerType !== "mouse" && d) { show(d); later(); } // a finger does not move before it is there
    if (state.globe) { drag = [...place(event), ...state.turn]; canvas.setPointerCapture(event.pointerId); }
  });
  addEventListener("resize", later);
  canvas.addEventListener("pointerup", () => { if (drag) { drag = null; later(); } });
  canvas.addEventListener("pointermove", event => {
    const [x, y] = place(event);
    if (drag) {
      state.turn = [drag[2] - (x - drag[0]) / radius(), Math.max(-1.57, Math.min(1.57, drag[3] + (y - drag[1]) / radius()))];
      later();
    } else { state.at = null; const d = directionAt(x, y); say(d ? words(d) : null); }
  });
  canvas.addEventListener("keydown", event => {
    const step = {ArrowLeft: [-6, 0], ArrowRight: [6, 0], ArrowUp: [0, -6], ArrowDown: [0, 6]}[event.key];
    if (!step) return;
    event.preventDefault();
    const from = state.at && pixelOf(state.at) || [width() / 2, height() / 2], to = directionAt(from[0] + step[0], from[1] + step[1]);
    if (to) { show(to); later(); }
  });
  return {state, draw, cellOf, directionAt, pixelOf, words, set(change) { Object.assign(state, change); draw(); }};
}
