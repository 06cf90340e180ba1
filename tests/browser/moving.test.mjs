/** The picture while the view moves: its noise is filtered, and at rest nothing of the filter is left. */
import assert from 'node:assert/strict';
import { it } from 'node:test';
import { assertNoComplaints, describeInBrowsers, open, still } from './browser.mjs';
import { build, view } from './program.mjs';

describeInBrowsers('a moving view', (_, browser) => {
  it('has at most three quarters of the noise of its rays, and the picture at rest is that of its samples', async () => {
    const server = await view(build('courtyard', 256));
    const page = await open(browser(), `${server.url}#eye=-6,2,3&target=5,1,-4&fov=60`, { width: 160, height: 100 });
    await still(page);
    const { noise, smoothed, isExact } = await page.evaluate(async () => {
      const { viewer } = /** @type {any} */ (window).voxdag, { renderer, gl, canvas: { width, height } } = viewer;
      const load = (/** @type {string} */ name) => import(new URL(name, document.baseURI).href);
      const { Picture } = await load('gpu/picture.js'), { Smoother } = await load('gpu/smoother.js');
      const render = (/** @type {any} */ shot, samples = 1) => {
        const picture = new Picture(gl, width, height);
        while (picture.samples < samples) renderer.render(picture, shot, height);
        return picture;
      };
      const sums = (/** @type {any} */ picture) => {
        gl.bindFramebuffer(gl.FRAMEBUFFER, picture.sumTargets[picture.current]);
        const values = new Float32Array(4 * width * height);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, values);
        return values.map((x) => x / picture.samples);
      };
      const atRest = sums(viewer.pictures.full), whole = sums(render(viewer.shot(false), 16));
      // From here on all view rays pass through the pixels' centres: the difference is noise, without the edges.
      const setCast = renderer.setCast.bind(renderer);
      renderer.setCast = (/** @type {any} */ program, /** @type {any} */ shot, /** @type {any} */ picture) => {
        setCast(program, shot, picture);
        program.floats({ u_sample: [0.5, 0.5] });
      };
      const smoother = new Smoother(renderer), { eye, ...camera } = viewer.camera();
      let picture = null;
      for (let i = 0; i < 6; ++i) {
        viewer.set({ camera: { ...camera, eye: [eye[0] + 0.05 * i, eye[1], eye[2]] } });
        const shot = { ...viewer.shot(true), smoothed: i };
        picture = render(shot);
        smoother.apply(picture, shot);
      }
      const finished = sums(render(viewer.shot(true), 16));
      const rms = (/** @type {any} */ other) => Math.sqrt(sums(other).reduce((sum, x, i) => sum + (x - finished[i]) ** 2, 0) / finished.length);
      return { noise: rms(render(viewer.shot(true))), smoothed: rms(picture), isExact: atRest.every((x, i) => x === whole[i]) };
    });
    assert.ok(smoothed < 0.75 * noise, `${smoothed}, and ${noise} without the filter`);
    assert.ok(isExact, 'the picture at rest');
    assertNoComplaints(page);
    await page.close();
    await server.close();
  });
});
