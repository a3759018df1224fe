// Flat pictures: axes with units, level curves of a potential, curves over time.
const INK = {motion: "{{ style.VIOLET }}", separatrix: "{{ style.BLACK }}", level: "#B5B5B5", stable: "{{ style.BLUE }}", unstable: "{{ style.VERMILION }}", size: "{{ style.BLACK }}", limit: "{{ style.VERMILION }}", components: {{ style.AXES|list|tojson }}};

function rounded(value) { return (Math.abs(value) < 1e5 ? String(+value.toPrecision(6) || 0) : value.toExponential().replace("e+", "e")).replace("-", "\u2212"); }

function ticks(low, high, number, room) {  // round numbers, about so many; closer ones where that gives less than three, if their words have room
  const rough = (high - low) / number, ten = 10 ** Math.floor(Math.log10(rough)), k = [1, 2, 5, 10].find(k => k * ten >= rough);
  const spread = every => { const found = []; for (let v = Math.ceil(low / every) * every; v <= high + 1e-9 * every; v += every) found.push(Math.abs(v) < 1e-9 * every ? 0 : v); return found; };
  const found = spread(k * ten);
  if (found.length >= 3) return found;
  const closer = spread({1: 0.5, 2: 1, 5: 2, 10: 5}[k] * ten);
  return room(closer) ? closer : found;
}

// Clears a canvas and draws its axes; returns the pen, clipped to the picture, and the way from numbers to pixels and back. The processor draws
// (willReadFrequently): where a graphics card is emulated, its lines cost some five times as much.
function picture(canvas, [left, right], [low, high], across, up) {
  const sharp = Math.min(window.devicePixelRatio || 1, 2), wide = canvas.clientWidth || 400, tall = canvas.clientHeight || 270, pen = canvas.getContext("2d", {willReadFrequently: true});
  if (canvas.width !== Math.round(wide * sharp) || canvas.height !== Math.round(tall * sharp)) { canvas.width = Math.round(wide * sharp); canvas.height = Math.round(tall * sharp); }
  pen.setTransform(sharp, 0, 0, sharp, 0, 0); pen.clearRect(0, 0, wide, tall);
  const box = {left: 58, right: wide - 12, top: 10, bottom: tall - 42};
  pen.font = "12px system-ui, sans-serif";
  const upward = ticks(low, high, Math.max(3, tall / 55), found => found.length * 20 < box.bottom - box.top);
  box.left = Math.max(box.left, 27 + Math.max(0, ...upward.map(v => pen.measureText(rounded(v)).width)));  // the label stands left of the widest number
  const x = v => box.left + (v - left) / (right - left) * (box.right - box.left), y = v => box.bottom - (v - low) / (high - low) * (box.bottom - box.top);
  pen.lineWidth = 0.6; pen.strokeStyle = "#DDDDDD"; pen.fillStyle = "#333333";
  pen.textAlign = "center"; pen.textBaseline = "top";
  const beside = found => found.reduce((sum, v) => sum + pen.measureText(rounded(v)).width + 12, 0) < box.right - box.left;
  for (const v of ticks(left, right, Math.max(3, wide / 90), beside)) { pen.beginPath(); pen.moveTo(x(v), box.top); pen.lineTo(x(v), box.bottom); pen.stroke(); pen.fillText(rounded(v), x(v), box.bottom + 5); }
  pen.textAlign = "right"; pen.textBaseline = "middle";
  for (const v of upward) { pen.beginPath(); pen.moveTo(box.left, y(v)); pen.lineTo(box.right, y(v)); pen.stroke(); pen.fillText(rounded(v), box.left - 5, y(v)); }
  pen.fillStyle = "#000000"; pen.textAlign = "center"; pen.textBaseline = "bottom"; pen.fillText(across, (box.left + box.right) / 2, tall - 4);
  pen.save(); pen.translate(12, (box.top + box.bottom) / 2); pen.rotate(-Math.PI / 2); pen.textBaseline = "middle"; pen.fillText(up, 0, 0); pen.restore();
  pen.strokeStyle = "#666666"; pen.lineWidth = 0.8; pen.strokeRect(box.left, box.top, box.right - box.left, box.bottom - box.top);
  pen.save(); pen.beginPath(); pen.rect(box.left, box.top, box.right - box.left, box.bottom - box.top); pen.clip();
  return {pen, x, y, left: px => left + (px - box.left) / (box.right - box.left) * (right - left), up: py => low + (box.bottom - py) / (box.bottom - box.top) * (high - low)};
}

function line(art, points, colour, width, dash = []) {
  const {pen, x, y} = art; pen.strokeStyle = colour; pen.lineWidth = width; pen.setLineDash(dash); pen.beginPath();
  points.forEach(([a, b], i) => i ? pen.lineTo(x(a), y(b)) : pen.moveTo(x(a), y(b))); pen.stroke(); pen.setLineDash([]);
}

function dot(art, a, b, fill, edge, square = false) {
  const {pen, x, y} = art; pen.fillStyle = fill; pen.strokeStyle = edge; pen.lineWidth = 1.6; pen.beginPath();
  if (square) pen.rect(x(a) - 4, y(b) - 4, 8, 8); else pen.arc(x(a), y(b), 4.2, 0, 7);
  pen.fill(); pen.stroke();
}

// The connected pieces [[turn, W], ...] of W >= 0 with W^2/2 + V = energy, closed at W = 0 where the potential cuts it.
function pieces(turns, heights, energy, slack) {
  const found = []; let now = null;
  for (let i = 0; i < turns.length; i++) {
    const left = energy - heights[i], before = i ? energy - heights[i - 1] : NaN;
    const edge = () => [turns[i - 1] + (turns[i] - turns[i - 1]) * before / (before - left), 0];
    if (left > -slack) { if (!now) { now = i ? [edge()] : []; found.push(now); } now.push([turns[i], Math.sqrt(2 * Math.max(left, 0))]); }
    else { if (now) now.push(edge()); now = null; }
  }
  return found;
}

function drawPlane(canvas, plane, cross) {
  const {turns, heights} = plane, rests = plane.rests, saddles = rests.filter(r => r.saddle);
  const least = Math.min(...heights), top = Math.max(plane.energy, ...saddles.map(r => r.height)), lift = top - least || 1e-12, energies = [];
  const W = Math.sqrt(2 * lift) * 1.12 + 1e-12, [zero, per] = plane.rate, rate = w => zero + per * w;
  const low = Math.min(rate(-W), rate(W)), high = Math.max(rate(-W), rate(W)), first = turns[0], last = turns[turns.length - 1];
  const art = picture(canvas, [Math.min(first, last), Math.max(first, last)], [low, high], plane.x, plane.y), slack = 1e-7 * lift;
  const both = (points, colour, width, ways = [1, -1]) => ways.forEach(way => line(art, points.map(([a, w]) => [a, rate(way * w)]), colour, width));
  for (let n = 1; n <= 14; n++) energies.push(least + lift * 1.25 * (n / 14) ** 1.4);
  energies.forEach(energy => pieces(turns, heights, energy, 0).forEach(points => both(points, INK.level, 0.8)));
  const spans = (points, at) => { const ends = points.map(p => p[0]), step = Math.abs(turns[1] - turns[0]); return Math.min(...ends) - step <= at && at <= Math.max(...ends) + step; };
  saddles.forEach(r => pieces(turns, heights, r.height, slack).filter(points => spans(points, r.at)).forEach(points => both(points, INK.separatrix, 1.7)));
  const rotating = plane.rotates && plane.energy > Math.max(...heights);
  pieces(turns, heights, plane.energy, 1e-12 * lift).filter(points => spans(points, 0)).forEach(points => both(points, INK.motion, 2.4, rotating ? [Math.sign(plane.start)] : [1, -1]));
  rests.forEach(r => r.saddle ? dot(art, r.at, zero, "#fff", INK.unstable) : dot(art, r.at, zero, INK.stable, INK.stable));
  dot(art, 0, rate(plane.start), "#000", "#000", true);
  if (cross) { line(art, [[cross[0], low], [cross[0], high]], "#666", 1, [3, 3]); line(art, [[first, cross[1]], [last, cross[1]]], "#666", 1, [3, 3]); }
  art.pen.restore();
  return {at: (px, py) => [art.left(px), art.up(py)], span: [first, last, low, high], start: [0, rate(plane.start)]};
}

// The ends of the periods that are drawn: not so many that they cover the curves.
function periods({times, period}) {
  const last = times[times.length - 1];
  return period && last / period < 40 ? Array.from({length: Math.floor(last / period)}, (_, n) => (n + 1) * period) : [];
}

function drawTime(canvas, data) {
  const {times, rates, extremes, size, limits, reached} = data, all = [...rates, size, ...(limits.length ? [limits] : [])].flatMap(row => [Math.min(...row), Math.max(...row)]);
  let low = Math.min(...all), high = Math.max(...all); const room = high - low || Math.abs(high) || 1;
  for (const pair of extremes || []) for (const v of pair) if (v !== null && v > low - 0.6 * room && v < high + 0.6 * room) { low = Math.min(low, v); high = Math.max(high, v); }
  const pad = 0.06 * (high - low || 2 * room), art = picture(canvas, [times[0], times[times.length - 1]], [low - pad, high + pad], data.x, data.y);
  for (const t of periods(data)) line(art, [[t, low - pad], [t, high + pad]], "#999999", 0.9);
  (extremes || []).forEach((pair, n) => pair.forEach(v => v !== null && line(art, [[times[0], v], [times[times.length - 1], v]], INK.components[n], 1, [1, 3])));
  line(art, Array.from(times, (t, i) => [t, size[i]]), INK.size, 2.4);
  limits.forEach(v => line(art, [[times[0], v], [times[times.length - 1], v]], INK.limit, 1.5, [6, 4]));
  if (limits.length) { art.pen.fillStyle = INK.limit; art.pen.textAlign = "right"; art.pen.textBaseline = "bottom"; art.pen.fillText(data.assumed ? "assumed limit" : "limit", art.x(times[times.length - 1]) - 4, art.y(Math.max(...limits)) - 2); }
  for (const end of [reached ?? []].flat()) if (end <= times[times.length - 1]) line(art, [[end, low - pad], [end, high + pad]], INK.limit, 1.5);
  rates.forEach((row, n) => line(art, Array.from(times, (t, i) => [t, row[i]]), INK.components[n], 1.5));
  art.pen.restore();
  return art;
}
