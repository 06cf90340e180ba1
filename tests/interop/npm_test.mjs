// Opens exported files with packages of others, and compares their voxels with voxdag's .npy.
//
//   VOXDAG=program node npm_test.mjs
//
// Ends with status 77 if the packages of package.json are not installed (`npm ci` here).
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { accessSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

const require = createRequire(import.meta.url);
let binvox, gltfValidator, nbt, readVox, viewer;
try {
  binvox = require("binvox");
  gltfValidator = require("gltf-validator");
  nbt = require("prismarine-nbt");
  readVox = require("vox-reader");
  viewer = fileURLToPath(new URL("node_modules/@playcanvas/supersplat-viewer/dist/viewer.js", import.meta.url));
  accessSync(viewer);
} catch (error) {
  console.log(`skipped: ${error.message.split("\n")[0]}`);
  process.exit(77);
}

const folder = mkdtempSync(path.join(tmpdir(), "voxdag-interop-"));
process.on("exit", () => rmSync(folder, { recursive: true }));
const at = (name) => path.join(folder, name);
const voxdag = (...words) => execFileSync(process.env.VOXDAG, words.map(String));
const exported = (name, ...options) => {
  voxdag("export", at("scene.vdag"), "-o", at(name), "-q", ...options);
  return readFileSync(at(name));
};

const resolution = 64;
let voxels; // "x,y,z" of all voxels
const key = (x, y, z) => `${x},${y},${z}`;

function makeScene() {
  // A ball with a colour for each vertex.
  const lines = [];
  const faces = [];
  const vertex = (p) => {
    lines.push(`v ${p.join(" ")} ${p.map((c) => Math.min(1, Math.max(0, c / 8 + 0.5)).toFixed(3)).join(" ")}`);
    return lines.length;
  };
  const steps = 24;
  const place = (i, j) => {
    const a = (i * Math.PI) / steps, b = (j * 2 * Math.PI) / steps;
    return [3 * Math.sin(a) * Math.cos(b), 3 * Math.sin(a) * Math.sin(b), 3 * Math.cos(a)];
  };
  for (let i = 0; i < steps; ++i)
    for (let j = 0; j < steps; ++j) {
      const [a, b, c, d] = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(([u, v]) => vertex(place(u, v % steps)));
      faces.push(`f ${a} ${b} ${c}`, `f ${a} ${c} ${d}`);
    }
  writeFileSync(at("ball.obj"), [...lines, ...faces].join("\n") + "\n");
  voxdag("build", at("ball.obj"), "-r", resolution, "--color", "-o", at("scene.vdag"), "-q");
  const npy = exported("voxels.npy", "--grey");
  const begin = npy.indexOf("\n") + 1;
  const numbers = new Int32Array(npy.buffer.slice(npy.byteOffset + begin, npy.byteOffset + npy.length));
  voxels = new Set();
  for (let i = 0; i < numbers.length; i += 3) voxels.add(key(...numbers.subarray(i, i + 3)));
  assert.ok(voxels.size > 1000);
}
makeScene();

test("Khronos's validator finds nothing to say about .glb", async () => {
  for (const options of [[], ["--grey"], ["--window", "3,5,7,40,41,42"]]) {
    const report = await gltfValidator.validateBytes(new Uint8Array(exported("a.glb", ...options)));
    assert.deepEqual(report.issues.messages, []);
    assert.ok(report.info.totalTriangleCount > 500);
  }
});

test("vox-reader finds the voxels and the scene of .vox", () => {
  const file = readVox(exported("a.vox"));
  const transforms = [file.ntrn].flat();
  const shapes = [file.nshp].flat();
  const [size] = [file.size].flat();
  assert.equal(shapes.length, 1);
  assert.deepEqual(size, { x: 64, y: 64, z: 64 });
  assert.equal(JSON.stringify(transforms).includes("0 0 32"), true);
  const found = new Set(file.xyzi.values.map((v) => key(v.x, v.y, v.z)));
  assert.deepEqual(found, voxels);
  const used = new Set(file.xyzi.values.map((v) => v.i));
  assert.ok(used.size > 100);
  for (const i of used) assert.ok(i >= 1 && i <= 255);
});

test("binvox finds the voxels of .binvox", () => {
  const bytes = exported("a.binvox");
  const file = new binvox.Parser().parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
  assert.deepEqual(file.dimension, { depth: resolution, width: resolution, height: resolution });
  assert.deepEqual(new Set(file.voxels.map((v) => key(v.x, v.y, v.z))), voxels);
});

test("prismarine-nbt finds the blocks of .schem", async () => {
  const { parsed } = await nbt.parse(exported("a.schem"));
  const schematic = nbt.simplify(parsed);
  assert.deepEqual([schematic.Width, schematic.Height, schematic.Length], [64, 64, 64]);
  const air = schematic.Palette["minecraft:air"];
  const found = new Set();
  schematic.BlockData.forEach((block, i) => {
    if (block !== air) found.add(key(i % 64, Math.floor(i / 4096), Math.floor(i / 64) % 64));
  });
  assert.deepEqual(found, voxels);
});

test("PlayCanvas's viewer collides with the voxels of .voxel.json", async () => {
  // The package exports its viewer only: a copy of its program also exports the reader. That needs no
  // engine, so the copy gets empty classes in place of PlayCanvas's.
  const program = readFileSync(viewer, "utf8").replace(
    /^import \{([^}]*)\} from ['"]playcanvas[^'"]*['"];/gm,
    (_, names) => `const {${names.replaceAll(" as ", ": ")}} = new Proxy({}, { get: () => class {} });`);
  writeFileSync(at("viewer.mjs"), program + "\nexport { loadVoxelCollision };\n");
  globalThis.fetch = async (file) => {
    const bytes = readFileSync(file);
    return {
      ok: true,
      json: async () => JSON.parse(bytes.toString()),
      arrayBuffer: async () => bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length),
    };
  };
  const { loadVoxelCollision } = await import(pathToFileURL(at("viewer.mjs")).href);
  voxdag("export", at("scene.vdag"), "-o", at("a.voxel.json"), "-q");
  const collision = await loadVoxelCollision(at("a.voxel.json"));
  assert.equal(collision.numVoxelsX, resolution);
  for (let z = 0; z < resolution; ++z)
    for (let y = 0; y < resolution; ++y)
      for (let x = 0; x < resolution; ++x)
        assert.equal(collision.isVoxelSolid(x, y, z), voxels.has(key(x, y, z)));
});
