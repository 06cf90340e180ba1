/**
 * Measures the viewer in headless Chromium, whose graphics card is software.
 *
 *   VOXDAG=build/release/apps/voxdag/voxdag node bench/viewer/measure.mjs FILE.vdag... -o result.json
 *
 * For each file: the times to the first picture and to the picture of all levels at several
 * bandwidths; the steps and milliseconds of the view rays of a picture of 1280 x 720, and those of a
 * plain octree walk in the same run; the memory. Needs `npm ci` in tests/browser.
 */
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { launch, open, still } from '../../tests/browser/browser.mjs';
import { proxy, view } from '../../tests/browser/program.mjs';

const WIDTH = 1280, HEIGHT = 720, REPEAT = 5;
const BANDWIDTHS = [1e6, 1e7, 1e8, Infinity];  // bits per second

const args = process.argv.slice(2), at = args.indexOf('-o');
const output = at < 0 ? null : args.splice(at, 2)[1];
if (args.length === 0) throw new Error('usage: node measure.mjs FILE.vdag... [-o RESULT.json]');
const plainWalk = fs.readFileSync(fileURLToPath(new URL('plain_walk.glsl', import.meta.url)), 'utf8');

/** @param {number[]} values */
const median = (values) => values.slice().sort((a, b) => a - b)[Math.floor(values.length / 2)];

/** The times at which pictures appear, in milliseconds since the page was asked for. @param {import('puppeteer-core').Browser} browser @param {string} url @param {number} bandwidth */
async function arrival(browser, url, bandwidth) {
  const line = await proxy(url, { bytesPerSecond: bandwidth / 8 });
  const page = await open(browser, `${line.url}#ao=0&shadows=off`, { width: 320, height: 180 });
  const times = await page.evaluate(() => new Promise((resolve) => {
    const { viewer } = /** @type {any} */ (window).voxdag;
    /** @type {{first?: number, firstBytes?: number}} */
    const times = {};
    viewer.on('frame', (/** @type {any} */ stats) => {
      if (times.first === undefined && stats.levelsShown > 0) Object.assign(times, { first: performance.now(), firstBytes: stats.bytesLoaded });
      if (stats.levelsShown === viewer.info?.levels) resolve({ ...times, all: performance.now() });
    });
  }));
  await page.close();
  line.close();
  return { megabits_per_second: bandwidth === Infinity ? null : bandwidth / 1e6, first_picture_ms: times.first, first_picture_bytes: times.firstBytes, all_levels_ms: times.all };
}

/** The walk of view rays at 1280 x 720, ours and the plain one in turn. @param {import('puppeteer-core').Browser} browser @param {string} url */
async function walks(browser, url) {
  const page = await open(browser, `${url}#ao=0&shadows=off`, { width: 320, height: 180 });
  await still(page);
  const result = await page.evaluate(async (plainWalk, width, height, repeat) => {
    const { viewer } = /** @type {any} */ (window).voxdag;
    const { Renderer } = await import(new URL('gpu/renderer.js', document.baseURI).href);
    const dag = viewer.shaders.get('dag'), begin = dag.indexOf('// Ends at cells of at most stop_start'), end = dag.indexOf('// Returns the side through which');
    const plain = new Renderer(viewer.gl, new Map([...viewer.shaders, ['dag', dag.slice(0, begin) + plainWalk + dag.slice(end)]]));
    const countSteps = (/** @type {any} */ renderer) => {
      const texts = new Map(renderer.shaders);
      texts.set('hits', String(texts.get('hits')).replaceAll('out_hit = uvec4(uvec3(cellOf', 'out_hit = uvec4(uvec3(g_steps)); return; out_hit = uvec4(uvec3(cellOf').replace('hit)) return;', 'hit)) { out_hit = uvec4(uvec3(g_steps), 0u); return; }').replace('uvec4(uvec3(g_steps)); return;', 'uvec4(uvec3(g_steps), 0u); return;'));
      const cells = new Renderer(viewer.gl, texts).hits(viewer.shot(false), width, height);
      let sum = 0;
      for (let i = 0; i < cells.length; i += 4) sum += cells[i];
      return sum / (cells.length / 4);
    };
    const times = { ours: /** @type {number[]} */ ([]), plain: /** @type {number[]} */ ([]) };
    const pictures = [viewer.renderer.hits(viewer.shot(false), width, height), plain.hits(viewer.shot(false), width, height)];
    const same = pictures[0].every((/** @type {number} */ v, /** @type {number} */ i) => v === pictures[1][i]);
    for (let i = 0; i < repeat; ++i)
      for (const [name, renderer] of [['ours', viewer.renderer], ['plain', plain]]) {
        const start = performance.now();
        renderer.hits(viewer.shot(false), width, height);
        times[/** @type {'ours'} */ (name)].push(performance.now() - start);
      }
    const stats = viewer.statistics();
    return { times, same, steps: { ours: countSteps(viewer.renderer), plain: countSteps(plain) },
            memory: { graphics_bytes: stats.gpuBytes, copy_bytes: viewer.memory.nodes.byteLength + viewer.memory.leaves.byteLength + viewer.memory.nodeInstances.byteLength + viewer.memory.leafInstances.byteLength } };
  }, plainWalk, WIDTH, HEIGHT, REPEAT);
  await page.close();
  if (!result.same) throw new Error('the plain walk hits other cells');
  return {
    ms: median(result.times.ours), steps_per_ray: result.steps.ours, plain_ms: median(result.times.plain), plain_steps_per_ray: result.steps.plain,
    ratio: median(result.times.plain.map((ms, i) => ms / result.times.ours[i])), memory: result.memory,
  };
}

const results = [];
for (const file of args) {
  const server = await view(path.resolve(file)), browser = await launch('chromium');
  const result = { file: path.basename(file), bytes: fs.statSync(file).size, walk: await walks(browser, server.url), arrival: /** @type {any[]} */ ([]) };
  console.log(`${result.file}  ${(result.bytes / 1e6).toFixed(1)} MB`);
  const { walk } = result;
  console.log(`  view rays at ${WIDTH} x ${HEIGHT}: ${walk.ms.toFixed(0)} ms, ${walk.steps_per_ray.toFixed(1)} steps; plain walk ${walk.plain_ms.toFixed(0)} ms, ` +
              `${walk.plain_steps_per_ray.toFixed(1)} steps: ${walk.ratio.toFixed(2)} times as long`);
  console.log(`  memory: ${(walk.memory.graphics_bytes / 1e6).toFixed(1)} MB of the graphics card, ${(walk.memory.copy_bytes / 1e6).toFixed(1)} MB of the page`);
  for (const bandwidth of BANDWIDTHS) {
    const seconds = (result.bytes * 8) / bandwidth;
    if (seconds > 300) continue;
    const times = await arrival(browser, server.url, bandwidth);
    result.arrival.push(times);
    console.log(`  ${times.megabits_per_second ?? 'unlimited'} Mbit/s: first picture after ${times.first_picture_ms?.toFixed(0)} ms (${times.first_picture_bytes} bytes), all levels after ${times.all_levels_ms?.toFixed(0)} ms`);
  }
  results.push(result);
  await browser.close();
  await server.close();
}
if (output !== null) fs.writeFileSync(output, JSON.stringify({ size: [WIDTH, HEIGHT], renderer: 'Chromium, SwiftShader', results }, null, 1) + '\n');
