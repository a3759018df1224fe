// The answers come from the program that opened this page.
function backend() {
  return async (kind, question, signal) => {
    const reply = await fetch(kind, {method: "POST", headers: {"Content-Type": "application/json"}, body: JSON.stringify(question), signal});
    if (reply.status === 204) return null;  // a newer question has come
    if (!reply.ok) throw new Error(`stabilab answered ${reply.status}: ${await reply.text()}`);
    return reply.arrayBuffer();
  };
}
