/** Materials of cells: which one is under the pointer, how many cells each has, and rays that pass through hidden ones. */
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { it } from 'node:test';
import { assertNoComplaints, describeInBrowsers, open } from './browser.mjs';
import { folder, view, voxdag } from './program.mjs';

/** A sphere of triangles, as OBJ. @param {number[]} center @param {number} first  Index of its first vertex. */
function sphere(center, first) {
  const lines = [], rows = 16, columns = 24;
  for (let r = 0; r <= rows; ++r)
    for (let c = 0; c < columns; ++c) {
      const a = Math.PI * r / rows, b = 2 * Math.PI * c / columns;
      lines.push(`v ${center[0] + 0.2 * Math.sin(a) * Math.cos(b)} ${center[1] + 0.2 * Math.cos(a)} ${center[2] + 0.2 * Math.sin(a) * Math.sin(b)}`);
    }
  for (let r = 0; r < rows; ++r)
    for (let c = 0; c < columns; ++c) {
      const at = (/** @type {number} */ i, /** @type {number} */ j) => first + i * columns + (j % columns);
      lines.push(`f ${at(r, c)} ${at(r + 1, c)} ${at(r + 1, c + 1)}`, `f ${at(r, c)} ${at(r + 1, c + 1)} ${at(r, c + 1)}`);
    }
  return lines.join('\n');
}

/** Builds spheres, each with a material, in one grid. Returns the file. @param {string} name @param {number[][]} centers */
function spheres(name, centers) {
  const mesh = path.join(folder, `${name}.obj`), file = path.join(folder, `${name}.vdag`);
  fs.writeFileSync(path.join(folder, 'spheres.mtl'), 'newmtl front\nnewmtl back\n');
  fs.writeFileSync(mesh, `mtllib spheres.mtl\n${centers.map((center, i) => `usemtl ${['front', 'back'][i]}\n${sphere(center, 1 + i * 17 * 24)}`).join('\n')}\n`);
  voxdag('build', mesh, '-r', '64', '--bounds', '0,0,0,1,1,1', '--material-ids', '-o', file, '-q');
  return file;
}

describeInBrowsers('materials', (_, browser) => {
  it('are named and counted, and rays of the page and of the pointer pass through hidden ones', async () => {
    const front = [0.5, 0.5, 0.75], back = [0.5, 0.45, 0.25];
    const both = spheres('both', [front, back]), alone = spheres('alone', [back]);
    const voxels = (/** @type {string} */ file) => JSON.parse(voxdag('info', file, '--json')).voxels;
    /** Opens a file from in front. @param {string} file */
    const load = async (file) => {
      const server = await view(file), page = await open(browser(), `${server.url}#ao=0&shadows=off`, { width: 1000, height: 120 });
      await page.waitForFunction('window.voxdag.viewer.arrival?.hasEnded');
      await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.set({ lod: 0, camera: { eye: [0.52, 0.5, 3], target: [0.5, 0.5, 0.5], up: [0, 1, 0], fov: 30 } }));
      // The open panel takes room from the picture.
      await page.evaluate(() => /** @type {any} */ (window).voxdag.ui.open('materials'));
      return { server, page };
    };
    const hits = (/** @type {import('puppeteer-core').Page} */ page) => page.evaluate(() => {
      const cells = Array.from(/** @type {Uint32Array} */ (/** @type {any} */ (window).voxdag.viewer.hits(64, 48)));
      return cells.map((x, i) => (i % 4 === 3 ? x & 0x1ffff : x)).join();  // without the steps
    });
    const pick = (/** @type {import('puppeteer-core').Page} */ page) => page.evaluate(async () => {
      const { viewer } = /** @type {any} */ (window).voxdag, hit = await viewer.pick(viewer.canvas.clientWidth / 2, 60);
      return { voxel: hit.voxel, face: hit.face, name: viewer.info.materials[viewer.material(hit)] };
    });
    const close = async (/** @type {Awaited<ReturnType<typeof load>>} */ { server, page }) => {
      assertNoComplaints(page);
      await page.close();
      await server.close();
    };
    const other = await load(alone), picked = await pick(other.page), shown = await hits(other.page);
    await close(other);
    const { server, page } = await load(both);
    assert.deepEqual(await page.evaluate(() => [/** @type {any} */ (window).voxdag.viewer.info.materials, /** @type {any} */ (window).voxdag.viewer.materialCounts()]),
      [['front', 'back'], [voxels(both) - voxels(alone), voxels(alone)]]);
    assert.equal((await pick(page)).name, 'front');
    const whole = await hits(page);

    // The front sphere is hidden by a click on it.
    await page.$$eval('.panel button', (all) => all.find((one) => one.textContent === 'Hide by clicking')?.click());
    await page.evaluate(() => {
      const { hands, viewer } = /** @type {any} */ (window).voxdag;
      hands.emit('click', viewer.canvas.clientWidth / 2, 60);
    });
    await page.waitForFunction('window.voxdag.viewer.get().hidden.join() === "0"');
    const behind = await pick(page);
    assert.equal(behind.name, 'back');
    assert.deepEqual(behind, { ...picked, name: 'back' });
    assert.notEqual(await hits(page), whole);
    assert.equal(await hits(page), shown, 'the page shows what a file of the other sphere shows');
    await page.evaluate(() => new Promise((resolve) => /** @type {any} */ (window).voxdag.viewer.on('frame', resolve)));
    await page.$$eval('.panel button', (all) => all.find((one) => one.textContent === 'Show all')?.click());
    assert.equal(await hits(page), whole);
    await close({ server, page });
  });
});
