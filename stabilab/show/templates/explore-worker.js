// Loads Python and the exact core of stabilab, and answers one question after another. What it needs, and from where, the page says.
let ready = null;

async function started({pyodide: place, wheels, arrays, name, text}) {
  const base = new URL(place, self.location.href).href, say = progress => self.postMessage({progress});
  say("Loading Python ...");
  const {loadPyodide} = await import(base + "pyodide.mjs"), python = await loadPyodide({indexURL: base});
  say("Loading python-flint ...");
  if (wheels) await python.loadPackage(wheels.map(file => base + file), {messageCallback: () => {}});
  else {
    await python.loadPackage("micropip", {messageCallback: () => {}});
    await python.runPythonAsync("import micropip\nawait micropip.install('python-flint')");
  }
  if (arrays) await python.loadPackage("numpy", {messageCallback: () => {}}).catch(() => {});  // without it there are no surfaces, and the page says so
  say("Loading stabilab ...");
  const packed = await fetch(new URL("stabilab.zip", self.location.href));
  if (!packed.ok) throw new Error(`stabilab.zip: ${packed.status}`);
  python.unpackArchive(await packed.arrayBuffer(), "zip", {extractDir: "/stabilab"});
  python.globals.set("case_name", name); python.globals.set("case_text", text);
  await python.runPythonAsync(`
import json, sys
sys.path.insert(0, "/stabilab")
from stabilab.case.read import read_text
from stabilab.show.explore.session import checked
from stabilab.show.explore.session import Session
session = Session(read_text(case_name, case_text))
ways = {"answer": session.answer, "verify": checked}
def answered(kind, question):
    return ways[kind](json.loads(question))
`);
  return python.globals.get("answered");
}

self.onmessage = async ({data}) => {
  if (data.setup) { ready = started(data.setup); ready.catch(error => self.postMessage({failed: `Python could not be loaded: ${error.message}`})); return; }
  try {
    const answered = await ready, made = answered(data.kind, data.question), reply = made.toJs().slice().buffer;
    made.destroy(); self.postMessage({number: data.number, reply}, [reply]);
  } catch (error) { self.postMessage({number: data.number, error: error.message}); }
};
