// A small model for the test to drop on the page: a floor, a wall and a lamp between, as a .glb.

const kFloat = 5126;
const kUnsignedShort = 5123;

/** @returns {Buffer} the file: two quads of two triangles, a point light at (0, 1, 0.8), a camera before them */
export function make_glb() {
  const positions = new Float32Array([
    -2, 0, -1, 2, 0, -1, 2, 0, 2, -2, 0, 2,    // floor
    -2, 0, -1, 2, 0, -1, 2, 2.5, -1, -2, 2.5, -1,  // wall
  ]);
  const indices = new Uint16Array([0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7]);
  const binary = Buffer.concat([Buffer.from(positions.buffer), Buffer.from(indices.buffer)]);
  const document = {
    asset: { version: "2.0" },
    extensionsUsed: ["KHR_lights_punctual"],
    extensions: {
      KHR_lights_punctual: { lights: [{ type: "point", name: "lamp", intensity: 40, color: [1, 0.8, 0.6] }] },
    },
    scene: 0,
    scenes: [{ nodes: [0, 1, 2] }],
    nodes: [
      { mesh: 0, name: "corner" },
      { name: "lamp", translation: [0, 1, 0.8], extensions: { KHR_lights_punctual: { light: 0 } } },
      { name: "eye", translation: [0, 1.2, 5], camera: 0 },
    ],
    cameras: [{ type: "perspective", perspective: { yfov: 0.7, znear: 0.05 } }],
    materials: [{
      pbrMetallicRoughness: { baseColorFactor: [0.8, 0.8, 0.8, 1], metallicFactor: 0, roughnessFactor: 1 },
      doubleSided: true,
    }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 }, indices: 1, material: 0 }] }],
    accessors: [
      { bufferView: 0, componentType: kFloat, count: 8, type: "VEC3", min: [-2, 0, -1], max: [2, 2.5, 2] },
      { bufferView: 1, componentType: kUnsignedShort, count: 12, type: "SCALAR" },
    ],
    bufferViews: [
      { buffer: 0, byteOffset: 0, byteLength: positions.byteLength },
      { buffer: 0, byteOffset: positions.byteLength, byteLength: indices.byteLength },
    ],
    buffers: [{ byteLength: binary.length }],
  };
  const text = Buffer.from(JSON.stringify(document));
  return chunks([["JSON", text, " "], ["BIN\0", binary, "\0"]]);
}

function chunks(parts) {
  const body = Buffer.concat(parts.flatMap(([name, data, filler]) => {
    const padded = Buffer.concat([data, Buffer.alloc(-data.length & 3, filler)]);
    const head = Buffer.alloc(8);
    head.writeUInt32LE(padded.length, 0);
    head.write(name, 4, "latin1");
    return [head, padded];
  }));
  const head = Buffer.alloc(12);
  head.write("glTF", 0, "latin1");
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(12 + body.length, 8);
  return Buffer.concat([head, body]);
}
