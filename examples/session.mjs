#!/usr/bin/env node
// A session with JavaScript's fetch (Node 18 or a browser's console): moves a light and saves a picture before and after.
//   examples/session.mjs FOLDER
// LIGHTWELL_URL (http://127.0.0.1:8080) is the server, LIGHTWELL_TOKEN the token if it asks for one.
import { mkdir, writeFile } from "node:fs/promises";
import path from "node:path";

const url = process.env.LIGHTWELL_URL ?? "http://127.0.0.1:8080";
const token = process.env.LIGHTWELL_TOKEN;
const folder = process.argv[2];
if (!folder) {
  console.error("usage: session.mjs FOLDER");
  process.exit(2);
}

/** The response; a refusal is an error in the server's words. */
async function ask(method, address, body) {
  const headers = { ...(token && { authorization: `Bearer ${token}` }), ...(body && { "content-type": "application/json" }) };
  const response = await fetch(url + address, { method, headers, body: body && JSON.stringify(body) });
  if (response.ok) return response;
  const { title, detail, pointer = "" } = await response.json();
  throw new Error(`${title}: ${detail} ${pointer}`);
}

async function save(session, name) {
  const picture = await ask("GET", `/v1/sessions/${session}/frame?format=png`);
  await writeFile(path.join(folder, name), new Uint8Array(await picture.arrayBuffer()));
  console.log(path.join(folder, name));
}

await mkdir(folder, { recursive: true });
const wanted = { scene: "cornell", width: 160, height: 120, playing: false, settings: { samples: 8, exposure_ev: -4 } };
const { id } = await (await ask("POST", "/v1/sessions", wanted)).json();
await save(id, "before.png");
const edit = { op: "replace", path: "/extensions/KHR_lights_punctual/lights/0/color", value: [1, 0.2, 0.1] };
await ask("PATCH", `/v1/sessions/${id}`, { edits: [edit] });
await save(id, "after.png");
await ask("DELETE", `/v1/sessions/${id}`);
