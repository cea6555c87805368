// web_client/protocol.js against protocol/golden_vectors.json: node --test tests/protocol/protocol.test.mjs
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

const root = new URL("../../", import.meta.url);
const vectors = JSON.parse(readFileSync(new URL("protocol/golden_vectors.json", root), "utf8"));

// Imported from its text: node would take the .js of a folder without a package.json for CommonJS.
const source = readFileSync(new URL("web_client/protocol.js", root), "base64");
const protocol = await import(`data:text/javascript;base64,${source}`);

const buffer_of = (hex) => new Uint8Array(Buffer.from(hex, "hex")).buffer;
const hex_of = (buffer) => Buffer.from(buffer).toString("hex");
const header_of = (vector) => ({ ...vector.header, scene_revision: BigInt(vector.header.scene_revision) });
const text_of = (vector) => vector.text ?? JSON.stringify(vector.message);

for (const vector of [...vectors.frames, ...vectors.lenient_frames]) {
  test(`frame: ${vector.name}`, () => {
    const { header, payload } = protocol.decode_frame(buffer_of(vector.bytes));
    assert.deepEqual(header, header_of(vector));
    assert.equal(hex_of(payload), vector.bytes.slice(2 * protocol.frame_header_bytes));
  });
}

for (const vector of vectors.frames) {
  test(`frame written: ${vector.name}`, () => {
    const payload = new Uint8Array(buffer_of(vector.bytes)).subarray(protocol.frame_header_bytes);
    assert.equal(hex_of(protocol.encode_frame(header_of(vector), payload)), vector.bytes);
  });
}

for (const vector of vectors.invalid_frames) {
  test(`invalid frame: ${vector.name}`, () => {
    assert.throws(() => protocol.decode_frame(buffer_of(vector.bytes)),
      { name: "ProtocolError", detail: vector.detail });
  });
}

const build = {
  hello: ({ type, ...options }) => protocol.hello(options),
  input: ({ type, seq, ...change }) => protocol.input(seq, change),
  look: ({ type, seq, ...own }) => protocol.look(seq, own),
  ack: ({ type, frame, ...timing }) => protocol.ack(frame, timing),
  demotion: ({ reason }) => protocol.demotion(reason),
  ping: ({ t }) => protocol.ping(t),
};

for (const vector of vectors.client_messages) {
  test(`client message: ${vector.name}`, () => {
    assert.deepEqual(protocol.parse_client_message(text_of(vector)), vector.message);
    const built = JSON.parse(build[vector.message.type](vector.message));
    const camera_default = built.camera && vector.means?.camera ? { camera: { yfov: 0.8, ...built.camera } } : {};
    assert.deepEqual({ ...built, ...camera_default }, vector.means ?? vector.message);
  });
}

for (const vector of vectors.server_messages) {
  test(`server message: ${vector.name}`, () => {
    assert.deepEqual(protocol.parse_message(text_of(vector)), vector.message);
  });
}

function refuses(parse, vector) {
  const expected = { name: "ProtocolError" };
  if (vector.status === 422) expected.pointer = vector.pointer;
  assert.throws(() => parse(text_of(vector)), expected);
}

for (const vector of vectors.invalid_client_messages.filter((candidate) => !candidate.lenient_in_browsers)) {
  test(`invalid client message: ${vector.name}`, () => refuses(protocol.parse_client_message, vector));
}

for (const vector of vectors.invalid_server_messages) {
  test(`invalid server message: ${vector.name}`, () => refuses(protocol.parse_message, vector));
}

test("what does not travel is left out", () => {
  assert.equal(protocol.input(1, { camera: undefined, playing: true }), '{"type":"input","seq":1,"playing":true}');
});

test("a builder refuses what the server would refuse", () => {
  assert.throws(() => protocol.input(1, { time_s: NaN }), { name: "ProtocolError", pointer: "/time_s" });
  assert.throws(() => protocol.input(0, {}), { name: "ProtocolError", pointer: "/seq" });
  assert.throws(() => protocol.ping(Infinity), { name: "ProtocolError", pointer: "/t" });
});
