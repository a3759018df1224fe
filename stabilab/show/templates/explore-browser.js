// The answers come from Python in this very browser, in a worker.
function backend() {
  const waiting = new Map(); let worker, number = 0;
  const failed = words => { waiting.forEach(({reject}) => reject(new Error(words))); waiting.clear(); };
  const unserved = "This page must come from a web server, for instance: python -m http.server in its folder";
  if (location.protocol === "file:") return () => Promise.reject(new Error(unserved));
  try { worker = new Worker("worker.js", {type: "module"}); } catch (error) { return () => Promise.reject(error); }
  worker.onerror = event => failed(`${setup.python.words} could not be loaded: ${event.message || "worker.js is missing"}`);
  worker.onmessage = ({data}) => {
    if (data.progress) { if (!shown) $("headline").textContent = data.progress; return; }
    if (data.failed) { failed(data.failed); return; }
    const one = waiting.get(data.number); waiting.delete(data.number);
    if (one) data.error ? one.reject(new Error(data.error)) : one.resolve(data.reply);
  };
  worker.postMessage({setup: setup.python});
  return (kind, question) => new Promise((resolve, reject) => { waiting.set(++number, {resolve, reject}); worker.postMessage({number, kind, question: JSON.stringify(question)}); });
}
