/**
 * Measures the noise of pictures of a moving view, before and after gpu/smoother.js, in headless Chromium.
 *
 *   VOXDAG=build/release/apps/voxdag/voxdag node lab/viewer/noise.mjs FILE.vdag[#SETTINGS]... [--pictures FOLDER]
 *
 * The camera turns around the scene's home view for a few frames. Prints, for the last frame: the root mean square of the
 * differences in brightness (of 255) from the picture with all samples, of one sample per pixel and of the smoothed one; and
 * the milliseconds of a frame. Needs `npm ci` in tests/browser.
 */
import fs from 'node:fs';
import path from 'node:path';
import { launch, open } from '../../tests/browser/browser.mjs';
import { view } from '../../tests/browser/program.mjs';

const WIDTH = 320, HEIGHT = 200, FRAMES = 12, DEGREES = 1.5, REPEAT = 5;

const args = process.argv.slice(2), at = args.indexOf('--pictures');
const folder = at < 0 ? null : args.splice(at, 2)[1];
if (args.length === 0) throw new Error('usage: node noise.mjs FILE.vdag[#SETTINGS]... [--pictures FOLDER]');

const browser = await launch('chromium');
for (const arg of args) {
  const [file, hash = ''] = arg.split('#'), server = file.startsWith('http') ? { url: file, close: async () => {} } : await view(path.resolve(file));
  const page = await open(browser, `${server.url}#${hash}`, { width: WIDTH, height: HEIGHT });
  await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.started.then(() => /** @type {any} */ (window).voxdag.viewer.arrival.ended));
  const { strip, ...numbers } = await page.evaluate(measure, FRAMES, DEGREES, REPEAT);
  console.log(JSON.stringify({ file: path.basename(file), width: WIDTH, height: HEIGHT, frames: FRAMES, degrees_per_frame: DEGREES, ...numbers }));
  if (folder !== null) fs.writeFileSync(path.join(folder, `${path.basename(file, '.vdag')}.png`), Buffer.from(strip.split(',')[1], 'base64'));
  await page.close();
  await server.close();
}
await browser.close();

/** Runs in the page. @param {number} frames @param {number} degrees @param {number} repeat */
async function measure(frames, degrees, repeat) {
  const { viewer } = /** @type {any} */ (window).voxdag;
  const load = (/** @type {string} */ name) => import(new URL(name, document.baseURI).href);
  const { Picture } = await load('gpu/picture.js'), { Smoother } = await load('gpu/smoother.js');
  const { readPixels } = await load('gpu/capture.js'), { finished } = await load('gpu/gl_tools.js');
  const { rotated, add, sub } = await load('math.js');
  const { renderer, gl, canvas: { width, height } } = viewer, first = viewer.camera();
  /** Renders a picture of a shot. */
  const render = (/** @type {any} */ shot, samples = 1) => {
    const picture = new Picture(gl, width, height);
    while (picture.samples < samples) renderer.render(picture, shot, height);
    return picture;
  };
  // All view rays pass through the pixels' centres: the difference is noise, and not the smoother edges of more rays.
  const setCast = renderer.setCast.bind(renderer);
  renderer.setCast = (/** @type {any} */ program, /** @type {any} */ shot, /** @type {any} */ picture) => {
    setCast(program, shot, picture);
    program.floats({ u_sample: [0.5, 0.5] });
  };
  const median = (/** @type {number[]} */ values) => values.sort((a, b) => a - b)[values.length >> 1];
  const smoother = new Smoother(renderer);
  /** @type {{[name: string]: any}} */
  const last = {};
  const times = { one_sample_ms: /** @type {number[]} */ ([]), smoothing_ms: /** @type {number[]} */ ([]) };
  for (let frame = 0; frame < frames; ++frame) {
    const angle = (frame - frames) * degrees * Math.PI / 180;
    viewer.set({ camera: { ...first, eye: add(first.target, rotated(sub(first.eye, first.target), first.up, angle)) } });
    const shot = viewer.shot(true);
    await finished(gl);
    const begin = performance.now();
    const picture = render({ ...shot, smoothed: frame % shot.samples });
    await finished(gl);
    const middle = performance.now();
    smoother.apply(picture, { ...shot, smoothed: frame % shot.samples });
    await finished(gl);
    if (frame >= frames - repeat) {
      times.one_sample_ms.push(middle - begin);
      times.smoothing_ms.push(performance.now() - middle);
    }
    if (frame === frames - 1) Object.assign(last, { smoothed: picture, one_sample: render(shot), finished: render(viewer.shot(false), shot.samples) });
    else picture.delete();
  }
  const exposure = renderer.exposureOf(last.finished);
  const pixels = Object.fromEntries(Object.entries(last).map(([name, picture]) => [name, readPixels(renderer, picture, exposure)]));
  const luma = (/** @type {Uint8ClampedArray} */ p, /** @type {number} */ i) => 0.299 * p[i] + 0.587 * p[i + 1] + 0.114 * p[i + 2];
  const rms = (/** @type {string} */ name) => {
    let sum = 0;
    for (let i = 0; i < pixels.finished.length; i += 4) sum += (luma(pixels[name], i) - luma(pixels.finished, i)) ** 2;
    return +Math.sqrt(sum / (width * height)).toFixed(2);
  };
  // The three pictures, one below the other.
  const strip = Object.assign(document.createElement('canvas'), { width, height: 3 * height });
  ['one_sample', 'smoothed', 'finished'].forEach((name, i) => {
    const image = new ImageData(width, height), row = 4 * width;
    for (let y = 0; y < height; ++y) image.data.set(pixels[name].subarray(row * (height - 1 - y), row * (height - y)), row * y);
    strip.getContext('2d')?.putImageData(image, 0, height * i);
  });
  return {
    rms_one_sample: rms('one_sample'), rms_smoothed: rms('smoothed'),
    one_sample_ms: +median(times.one_sample_ms).toFixed(1), smoothing_ms: +median(times.smoothing_ms).toFixed(1), strip: strip.toDataURL(),
  };
}
