/**
 * Measures the viewer in headless Chromium, whose graphics card is software.
 *
 *   VOXDAG=build/release/apps/voxdag/voxdag node lab/viewer/measure.mjs FILE.vdag... -o result.json
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

/** Returns the times at which pictures appear, in milliseconds since the page was asked for. @param {import('puppeteer-core').Browser} browser @param {string} url @param {number} bandwidth */
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

/**
 * Measures the walks of view rays at 1280 x 720: the page's and the plain one in turn.
 * @param {import('puppeteer-core').Browser} browser @param {string} url
 */
async function walks(browser, url) {
  const page = await open(browser, `${url}#ao=0&shadows=off`, { width: 320, height: 180 });
  await still(page);
  const result = await page.evaluate(async (plainWalk, width, height, repeat) => {
    const { viewer } = /** @type {any} */ (window).voxdag;
    const { Renderer } = await import(new URL('gpu/renderer.js', document.baseURI).href);
    const renderers = { ours: viewer.renderer, plain: new Renderer(viewer.gl, new Map([...viewer.shaders, ['walk', plainWalk]])) };
    const times = { ours: /** @type {number[]} */ ([]), plain: /** @type {number[]} */ ([]) };
    const steps = { ours: 0, plain: 0 };
    /** The cells that were hit, as text. @type {Set<string>} */
    const pictures = new Set();
    // The first round compiles the shaders and counts.
    for (let round = 0; round <= repeat; ++round)
      for (const [name, renderer] of /** @type {['ours' | 'plain', any][]} */ (Object.entries(renderers))) {
        const start = performance.now();
        /** @type {Uint32Array} */
        const cells = renderer.hits(viewer.shot(false), width, height);
        if (round > 0) {
          times[name].push(performance.now() - start);
          continue;
        }
        for (let i = 3; i < cells.length; i += 4) {
          steps[name] += (cells[i] >>> 17) / (width * height);
          cells[i] &= (1 << 17) - 1;
        }
        pictures.add(cells.join());
      }
    const { nodes, leaves, nodeInstances, leafInstances } = viewer.arrival.memory;
    const copyBytes = [nodes, leaves, nodeInstances, leafInstances].reduce((sum, array) => sum + array.byteLength, 0);
    return { times, steps, isSame: pictures.size === 1, memory: { graphics_bytes: viewer.statistics().gpuBytes, copy_bytes: copyBytes } };
  }, plainWalk, WIDTH, HEIGHT, REPEAT);
  await page.close();
  if (!result.isSame) throw new Error('the plain walk hits other cells');
  const { times, steps } = result;
  return {
    ms: median(times.ours), steps_per_ray: steps.ours, plain_ms: median(times.plain), plain_steps_per_ray: steps.plain,
    ratio: median(times.plain.map((ms, i) => ms / times.ours[i])), memory: result.memory,
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
