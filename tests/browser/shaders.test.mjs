/** shaders/voxdag.wgsl, run by WebGPU in software, against the page's own rays. */
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { describe, it } from 'node:test';
import { fileURLToPath } from 'node:url';
import { cast, contains } from '../../apps/viewer/page/trace.js';
import { launch } from './browser.mjs';
import { build, folder, serveFolder, voxdag } from './program.mjs';

const source = fs.readFileSync(fileURLToPath(new URL('../../shaders/voxdag.wgsl', import.meta.url)), 'utf8');

/** Casts rays: eye, stop.x, direction, t_max; and asks for a point beside. Hits: T's parameter, cell; face, level, found, contains. */
const MAIN = `
@group(0) @binding(0) var<storage, read> voxdag_nodes: array<u32>;
@group(0) @binding(1) var<storage, read> voxdag_leaves: array<vec2u>;
override voxdag_levels: i32;
@group(0) @binding(2) var<storage, read> rays: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> hits: array<vec4u>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {
  if (2u * id.x >= arrayLength(&rays)) { return; }
  let a = rays[2u * id.x];
  let b = rays[2u * id.x + 1u];
  let ray = voxdag_ray(a.xyz, b.xyz, b.w);
  let hit = voxdag_cast(ray, vec2f(a.w, 0.0));
  let is_set = voxdag_contains(vec3i(floor(a.xyz * f32(1 << u32(voxdag_levels)))), voxdag_levels);
  hits[2u * id.x] = vec4u(bitcast<u32>(ray.t_start + ray.t_scale * hit.t), hit.cell);
  hits[2u * id.x + 1u] = vec4u(bitcast<u32>(hit.face), u32(hit.level), u32(hit.found), u32(is_set));
}`;

/** Returns the words of the DAG of a file, as `trace.js` wants them, in a grid from (0, 0, 0) to (1, 1, 1). @param {string} file */
function readDag(file) {
  const bytes = fs.readFileSync(file), view = new DataView(bytes.buffer, bytes.byteOffset);
  /** @param {string} name @returns {Uint32Array} */
  const chunk = (name) => {
    for (let at = 64; at < 64 + 32 * view.getUint32(12, true); at += 32)
      if (bytes.toString('latin1', at, at + 4) === name) {
        const begin = Number(view.getBigUint64(at + 8, true)), length = Number(view.getBigUint64(at + 16, true));
        return new Uint32Array(Uint8Array.from(bytes.subarray(begin, begin + length)).buffer);
      }
    throw new Error(`no ${name}`);
  };
  const levels = JSON.parse(voxdag('info', file, '--json')).levels;
  return { levels, shown: levels, origin: /** @type {[number, number, number]} */ ([0, 0, 0]), voxelSize: 2 ** -levels, nodes: chunk('NODE'), leaves: chunk('LEAF') };
}

/** Runs the shader in the page. @param {string} code @param {number} levels @param {number[]} nodes @param {number[]} leaves @param {number[]} rays */
async function runInPage(code, levels, nodes, leaves, rays) {
  const gpu = /** @type {any} */ (navigator).gpu, w = /** @type {any} */ (window);
  const device = await (await gpu.requestAdapter()).requestDevice();
  const module = device.createShaderModule({ code });
  const { messages } = await module.getCompilationInfo();
  if (messages.length > 0) throw new Error(messages.map((/** @type {any} */ m) => `${m.lineNum}: ${m.message}`).join('\n'));
  const pipeline = await device.createComputePipelineAsync({ layout: 'auto', compute: { module, constants: { voxdag_levels: levels } } });
  /** @param {ArrayBufferView} data */
  const upload = (data) => {
    const buffer = device.createBuffer({ size: Math.max(data.byteLength, 16), usage: w.GPUBufferUsage.STORAGE | w.GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(buffer, 0, data);
    return buffer;
  };
  const size = rays.length * 4, hits = device.createBuffer({ size, usage: w.GPUBufferUsage.STORAGE | w.GPUBufferUsage.COPY_SRC });
  const buffers = [upload(new Uint32Array(nodes)), upload(new Uint32Array(leaves)), upload(new Float32Array(rays)), hits];
  const result = device.createBuffer({ size, usage: w.GPUBufferUsage.COPY_DST | w.GPUBufferUsage.MAP_READ });
  const encoder = device.createCommandEncoder(), pass = encoder.beginComputePass();
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries: buffers.map((buffer, binding) => ({ binding, resource: { buffer } })) }));
  pass.dispatchWorkgroups(Math.ceil(rays.length / 8 / 64));
  pass.end();
  encoder.copyBufferToBuffer(hits, 0, result, 0, size);
  device.queue.submit([encoder.finish()]);
  await result.mapAsync(w.GPUMapMode.READ);
  return [...new Uint32Array(result.getMappedRange())];
}

let state = 1;
/** Returns one of 0 to count - 1. @param {number} count */
function random(count) {
  state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
  return Math.floor(state / 4294967296 * count);
}

describe('shaders/voxdag.wgsl', { timeout: 840_000 }, () => {
  it('hits the voxels that the page hits, and holds the same points', async () => {
    const browser = await launch('chromium', '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader');
    fs.writeFileSync(path.join(folder, 'blank.html'), '<!doctype html>');
    const server = await serveFolder(folder), page = await browser.newPage();
    await page.goto(`${server.url}blank.html`);
    for (const [name, resolution] of /** @type {[string, number][]} */ ([['sponge', 4], ['sponge', 8], ['sponge', 128], ['courtyard', 512]])) {
      const dag = readDag(build(name, resolution));
      // All sums and products of these rays are exact in floats: eyes are multiples of 2^-10, directions powers of 2.
      const rays = [], expected = [];
      for (let i = 0; i < 20_000; ++i) {
        const inside = random(2) === 0, from = /** @type {[number, number, number]} */ ([0, 0, 0].map(() => (inside ? random(1024) : random(3072) - 1024) / 1024));
        const direction = /** @type {[number, number, number]} */ ([0, 0, 0].map(() => [0, 0.25, 0.5, 1, -0.25, -0.5, -1][random(7)]));
        const most = random(4) === 0 ? 0.5 : 3e38, level = random(4) === 0 ? 1 + random(dag.levels) : dag.levels;
        // No larger cell ends the ray: levels below the wanted one are half as large.
        rays.push(...from, level < dag.levels ? 2 ** -level : 0, ...direction, most);
        const hit = cast({ ...dag, shown: level }, from, direction, most);
        expected.push([hit && [hit.voxel.map((v) => v >> (dag.levels - level)), hit.level, hit.face, Math.fround(hit.distance)], contains(dag, from)]);
      }
      const words = await page.evaluate(runInPage, MAIN + source, dag.levels, [...dag.nodes], [...dag.leaves], rays);
      const floats = new Float32Array(Uint32Array.from(words).buffer);
      let hits = 0;
      expected.forEach((wanted, i) => {
        const at = 8 * i, found = words[at + 6] === 1;
        hits += Number(found);
        assert.deepEqual([found ? [words.slice(at + 1, at + 4), words[at + 5], words[at + 4] | 0, floats[at]] : null, words[at + 7] === 1], wanted, `${name} ${resolution}, ray ${rays.slice(at, at + 8)}`);
      });
      assert.ok(hits > 2000 && hits < 19_000, `${hits} hits`);
    }
    server.close();
    await browser.close();
  });
});
