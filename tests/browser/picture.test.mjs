/** The picture in real browsers: hits and light are those of the command line. */
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import path from 'node:path';
import { it } from 'node:test';
import { assertNoComplaints, describeInBrowsers, open, still } from './browser.mjs';
import { readHits, writeNpy } from './npy.mjs';
import { readPng, spread, ssim } from './pictures.mjs';
import { build, buildColored, folder, view, voxdag } from './program.mjs';

const WIDTH = 128, HEIGHT = 72;

/** Views of the court and of the coloured hill: world units. */
const VIEWS = {
  court: [
    { eye: [10, 3, 10], target: [0, 2, 0] }, { eye: [-6, 2, 3], target: [5, 1, -4] }, { eye: [0, 30, 40], target: [0, 0, 0] },
    { eye: [2, 1.5, 2], target: [2, 8, 2.5] }, { eye: [-20, 12, -20], target: [0, 3, 0] },
  ],
  hill: [
    { eye: [0.5, 0.9, 1.9], target: [0.5, 0, 0.5] }, { eye: [-0.4, 0.3, 0.2], target: [0.6, 0, 0.6] }, { eye: [0.5, 2, 0.51], target: [0.5, 0, 0.5] },
    { eye: [0.3, 0.2, 0.3], target: [0.8, 0.05, 0.7] }, { eye: [1.5, -0.6, 1.2], target: [0.5, 0, 0.5] },
  ],
};

/** Sections of views of the court: a plane, and a box. */
const SECTIONS = [
  { view: 2, section: { box: null, plane: { point: [0, 4, 1], normal: [0.1, 0.3, 1] } } },
  { view: 4, section: { box: { low: [-8, 0.5, -6], high: [9, 5, 8] }, plane: null } },
];

/** The size of pages whose own picture nobody looks at. */
const SMALL = { width: 160, height: 100 };

/** @param {string} name */
const fileOf = (name) => (name === 'court' ? build('courtyard', 512) : buildColored(256));

describeInBrowsers('pictures', (browserName, browser) => {
  it('shows a scene without complaints of the console or the security policy', async () => {
    const server = await view(build('courtyard', 256));
    const page = await open(browser(), server.url, SMALL);
    await still(page);
    const shot = path.join(folder, 'first.png');
    await page.screenshot({ path: shot });
    assert.ok(spread(readPng(shot)) > 5, 'the picture is not blank');
    assertNoComplaints(page);
    await page.close();
    await server.close();
  });

  it('hits the same voxels as `voxdag trace`, away from ties', async () => {
    for (const [name, shots] of Object.entries(VIEWS).map(([n, v]) => /** @type {[string, any[]]} */ ([n, v]))) {
      const file = fileOf(name), server = await view(file);
      const page = await open(browser(), `${server.url}#ao=0&shadows=off`, SMALL);
      await still(page);
      for (const { eye, target } of shots.slice(0, browserName === 'chromium' ? 5 : 2)) {
        const camera = { eye, target, up: [0.02, 1, 0.03], fov: 60 };
        const cells = await page.evaluate((camera, width, height) => {
          const { viewer } = /** @type {any} */ (window).voxdag;
          viewer.set({ camera, lod: 0 });
          return Array.from(viewer.hits(width, height));
        }, camera, WIDTH, HEIGHT);
        compareHits(file, camera, Uint32Array.from(/** @type {number[]} */ (cells)));
      }
      assertNoComplaints(page);
      await page.close();
      await server.close();
    }
  });

  if (browserName === 'chromium')
    it('lights five views of two scenes as `voxdag render` does: SSIM of at least 0.98', async () => {
      for (const [name, shots] of Object.entries(VIEWS).map(([n, v]) => /** @type {[string, any[]]} */ ([n, v]))) {
        const file = fileOf(name), server = await view(file);
        const page = await open(browser(), server.url, SMALL);
        for (const [i, { eye, target }] of shots.entries()) {
          const picture = path.join(folder, `${name}${i}.png`);
          voxdag('render', file, '-q', '--size', `${WIDTH}x${HEIGHT}`, '--spp', '16', '--fov', '60', '--up', '0,1,0',
                 '--eye', eye.join(','), '--target', target.join(','), '-o', picture);
          const png = await page.evaluate(async (camera, width, height) => {
            const { viewer } = /** @type {any} */ (window).voxdag;
            viewer.set({ camera, lod: 1, sun: { direction: null } });
            const blob = await viewer.capture({ width, height, samples: 16 });
            return Array.from(new Uint8Array(await blob.arrayBuffer()));
          }, { eye, target, up: [0, 1, 0], fov: 60 }, WIDTH, HEIGHT);
          const likeness = ssim(readPng(picture), readPng(Buffer.from(png)));
          assert.ok(likeness >= 0.98, `${name}, view ${i}: SSIM ${likeness}`);
        }
        assertNoComplaints(page);
        await page.close();
        await server.close();
      }
    });

  if (browserName === 'chromium')
    it('cuts sections as `voxdag render --view` does: SSIM of at least 0.99', async () => {
      const file = fileOf('court'), server = await view(file);
      const page = await open(browser(), server.url, SMALL);
      for (const [i, { view: shot, section }] of SECTIONS.entries()) {
        const picture = path.join(folder, `section${i}.png`), settings = path.join(folder, `section${i}.json`);
        const { eye, target } = VIEWS.court[shot];
        const shown = { camera: { eye, target, up: [0, 1, 0], fov: 60 }, section };
        writeFileSync(settings, JSON.stringify(shown));
        voxdag('render', file, '-q', '--size', `${WIDTH}x${HEIGHT}`, '--spp', '16', '--view', settings, '-o', picture);
        const png = await page.evaluate(async (settings, width, height) => {
          const { viewer } = /** @type {any} */ (window).voxdag;
          viewer.set({ ...settings, lod: 1, sun: { direction: null } });
          const blob = await viewer.capture({ width, height, samples: 16 });
          return Array.from(new Uint8Array(await blob.arrayBuffer()));
        }, shown, WIDTH, HEIGHT);
        const likeness = ssim(readPng(picture), readPng(Buffer.from(png)));
        assert.ok(likeness >= 0.99, `section ${i}: SSIM ${likeness}`);
      }
      assertNoComplaints(page);
      await page.close();
      await server.close();
    });
});

/**
 * Casts the rays of a camera by `voxdag trace`, and again at four places around the middle of each
 * pixel. Where all five hit the same voxel there is no tie, and the page must have hit it too.
 * @param {string} file @param {{eye: number[], target: number[], up: number[], fov: number}} camera @param {Uint32Array} cells
 */
function compareHits(file, camera, cells) {
  const offsets = [[0, 0], [0.02, 0.01], [-0.01, 0.02], [-0.02, -0.01], [0.01, -0.02]];
  const unit = (/** @type {number[]} */ v) => v.map((x) => x / Math.hypot(...v));
  const cross = (/** @type {number[]} */ a, /** @type {number[]} */ b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const forward = unit(camera.target.map((t, a) => t - camera.eye[a])), right = unit(cross(forward, camera.up)), up = cross(right, forward);
  const tan = Math.tan((camera.fov * Math.PI) / 360);
  const rays = new Float32Array(8 * offsets.length * WIDTH * HEIGHT);
  offsets.forEach(([dx, dy], o) => {
    for (let y = 0; y < HEIGHT; ++y)
      for (let x = 0; x < WIDTH; ++x) {
        const across = ((2 * (x + 0.5 + dx)) / WIDTH - 1) * tan * (WIDTH / HEIGHT), above = (1 - (2 * (y + 0.5 + dy)) / HEIGHT) * tan;
        const direction = forward.map((f, a) => f + right[a] * across + up[a] * above);
        rays.set([...camera.eye, 0, ...direction, 1e30], 8 * ((o * HEIGHT + y) * WIDTH + x));
      }
  });
  const input = path.join(folder, 'rays.npy'), output = path.join(folder, 'hits.npy');
  writeNpy(input, rays, 8);
  voxdag('trace', file, '--rays', input, '-o', output, '-q');
  const hits = readHits(output), pixels = WIDTH * HEIGHT;
  const same = (/** @type {any} */ a, /** @type {any} */ b) => a.hit === b.hit && (!a.hit || a.voxel.join() === b.voxel.join());
  let compared = 0;
  for (let i = 0; i < pixels; ++i) {
    if (!offsets.every((_, o) => same(hits[i], hits[o * pixels + i]))) continue;
    ++compared;
    const x = i % WIDTH, y = Math.floor(i / WIDTH), at = 4 * ((HEIGHT - 1 - y) * WIDTH + x);
    const shown = { hit: (cells[at + 3] >>> 16 & 1) === 1, voxel: Array.from(cells.subarray(at, at + 3)) };
    assert.ok(same(hits[i], shown), `pixel ${x}, ${y}: ${JSON.stringify(shown)} instead of ${JSON.stringify(hits[i])}`);
  }
  assert.ok(compared > pixels / 2, `only ${compared} of ${pixels} pixels are away from ties`);
}
