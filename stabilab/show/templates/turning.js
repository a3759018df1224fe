// The body as the box of its moments, turning in space: show(film) takes what is drawn, of `drawn` in show/plot/turning.py; moved(t) hears of the time that is shown.
const $ = id => document.getElementById(id);
function turningView() {
  const stage = $("stage"), pen = stage.getContext("2d"), view = {show, draw, moved: null};
  let data = null, at = 0, playing = false, before = null, up = 0.38, round = -0.96;
  const last = () => data.t.length - 1, rounded = value => +value.toPrecision(5), three = (row, n) => row.slice(3 * n, 3 * n + 3);
  const speeds = [0, 4, 8, 16, 32].map(s => Object.assign(document.createElement("option"), {value: s, textContent: s ? `${s} s for all` : "as in reality"}));
  $("speed").append(...speeds);

  function show(given) {
    if (!data) { play(!matchMedia("(prefers-reduced-motion: reduce)").matches); speeds[given.real > 4 && given.real < 60 && given.even.length < 2 ? 0 : given.even.length < 2 ? 2 : 3].selected = true; }
    speeds[0].hidden = given.even.length > 1;  // a film that goes slow and fast
    at = data ? at / (last() || 1) * (given.t.length - 1) : 0; data = given; $("at").max = last(); draw();
  }
  function play(on) { playing = on; $("play").textContent = on ? "Pause" : "Play"; }
  function turned(r, v) { return [r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[3] * v[0] + r[4] * v[1] + r[5] * v[2], r[6] * v[0] + r[7] * v[1] + r[8] * v[2]]; }
  function seen(v) { // [right, up, towards the eye]
    const c = Math.cos(round), s = Math.sin(round), u = Math.cos(up), w = Math.sin(up);
    return [-s * v[0] + c * v[1], -w * (c * v[0] + s * v[1]) + u * v[2], u * (c * v[0] + s * v[1]) + w * v[2]];
  }
  function draw() {
    if (!data || !stage.clientWidth) return;
    const n = Math.round(at), attitude = n => data.rotations.slice(9 * n, 9 * n + 9), r = attitude(n), size = stage.clientWidth, height = stage.clientHeight, dots = window.devicePixelRatio || 1;
    if (stage.width !== Math.round(size * dots) || stage.height !== Math.round(height * dots)) { stage.width = Math.round(size * dots); stage.height = Math.round(height * dots); }
    pen.setTransform(dots, 0, 0, dots, 0, 0); pen.clearRect(0, 0, size, height);
    const unit = Math.min(size, height) / 4, put = v => [size / 2 + unit * v[0], height / 2 - unit * v[1]];
    const line = (points, colour, width) => { pen.beginPath(); points.forEach((v, i) => { const p = put(v); i ? pen.lineTo(...p) : pen.moveTo(...p); });
      pen.strokeStyle = colour; pen.lineWidth = width; pen.stroke(); };
    const word = (text, v, colour) => { pen.fillStyle = colour; pen.font = "15px sans-serif"; const p = put(v);
      pen.strokeStyle = "#FFFFFF"; pen.lineWidth = 4; pen.lineJoin = "round"; pen.strokeText(text, p[0] - 4, p[1] + 5);  // to be read on a face of its colour
      pen.fillText(text, p[0] - 4, p[1] + 5); };
    [[1.7, 0, 0], [0, 1.7, 0], [0, 0, 1.7]].forEach((v, i) => { line([[0, 0, 0], seen(v)], "#BBBBBB", 1); word("XYZ"[i], seen(v.map(x => x * 1.07)), "#7A7A7A"); });
    const tip = [], from = (data.even.find(([a, b]) => a <= n && n <= b) || [n])[0]; for (let i = from; i <= n; i++) { const q = attitude(i); tip.push(seen([q[data.tip], q[3 + data.tip], q[6 + data.tip]].map(x => 1.5 * x))); }
    line(tip, "#7A7A7A", 1);
    const tips = [0, 1, 2].map(i => seen([r[i], r[3 + i], r[6 + i]].map(x => 1.5 * x)));
    const axis = i => { line([tips[i].map(x => x * data.edges[i] / 1.5), tips[i]], data.colours[i], 3); word(data.names[i], tips[i].map(x => x * 1.1), data.colours[i]); };
    [0, 1, 2].filter(i => tips[i][2] < 0).forEach(axis);
    const corners = data.corners.map(v => seen(turned(r, v)));
    data.faces.forEach((face, i) => {
      const middle = [0, 1, 2].map(k => face.reduce((sum, c) => sum + corners[c][k], 0));
      if (middle[2] <= 0) return; // turned away
      pen.beginPath(); face.forEach((c, k) => { const p = put(corners[c]); k ? pen.lineTo(...p) : pen.moveTo(...p); }); pen.closePath();
      pen.fillStyle = data.colours[i >> 1]; pen.globalAlpha = 0.45 + 0.4 * middle[2] / Math.hypot(...middle); pen.fill(); pen.globalAlpha = 1;
      pen.strokeStyle = "#1b1b1b"; pen.lineWidth = 1.2; pen.stroke();
    });
    [0, 1, 2].filter(i => tips[i][2] >= 0).forEach(axis);
    for (const [letter, colour, rows] of data.arrows) {
      const tip = seen(three(rows, n)), long = Math.hypot(tip[0], tip[1]) || 1, back = [-tip[0] / long, -tip[1] / long];
      line([[0, 0, 0], tip], colour, 2.5); word(letter, tip.map(x => x * 1.1), colour);
      line([1, 0, -1].map(side => side ? [tip[0] + 0.1 * back[0] + side * 0.05 * back[1], tip[1] + 0.1 * back[1] - side * 0.05 * back[0], 0] : tip), colour, 2.5);
    }
    $("limit").hidden = !data.share;
    $("limited").textContent = data.assumed ? "assumed limit" : "limit";
    if (data.share) { $("gauge").value = data.share[n]; $("share").textContent = `${Math.round(100 * data.share[n])} %`; }
    $("at").value = n; $("now").textContent = `${rounded(data.t[n])} ${data.unit}, |ω| = ${rounded(data.size[n])} ${data.rate}`;
    $("note-now").textContent = data.notes.filter(([a, b]) => a <= n && n <= b).map(([, , told]) => told).join("; ");
    if (view.moved) view.moved(data.t[n]);
  }
  function step(now) {
    if (playing && data && before !== null) { at += last() * (now - before) / 1000 / (Number($("speed").value) || (data.even.length > 1 ? 16 : data.real) || 1); if (at > last()) at = 0; draw(); }
    before = now; requestAnimationFrame(step);
  }
  const look = (across, upward) => { round += across; up = Math.max(-1.5, Math.min(1.5, up + upward)); draw(); };
  $("play").onclick = () => play(!playing);
  $("at").oninput = () => { at = Number($("at").value); play(false); draw(); };
  stage.onpointerdown = e => { stage.setPointerCapture(e.pointerId); stage.onpointermove = m => look(-0.01 * m.movementX, 0.01 * m.movementY); };
  stage.onpointerup = stage.onpointercancel = () => { stage.onpointermove = null; };
  stage.onkeydown = e => { const by = {ArrowLeft: [0.12, 0], ArrowRight: [-0.12, 0], ArrowUp: [0, 0.12], ArrowDown: [0, -0.12]}[e.key]; if (by) { e.preventDefault(); look(...by); } };
  window.addEventListener("resize", draw); requestAnimationFrame(step);
  return view;
}
