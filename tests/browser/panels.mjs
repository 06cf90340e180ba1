/**
 * Takes pictures of every panel, to be looked at: node panels.mjs FILE.vdag OUT/ [panel...] ; VOXDAG names the program, and
 * VOXDAG_BROWSER the browser (chromium); firefox needs a display: xvfb-run -a node panels.mjs ... Each at four sizes, light and
 * dark: OUT/panel-WIDTHxHEIGHT-scheme.png.
 */
import fs from 'node:fs';
import path from 'node:path';
import { launch } from './browser.mjs';
import { view } from './program.mjs';

const SIZES = [[1280, 800], [844, 390], [390, 844], [2560, 1440]];
const [file, out, ...wanted] = process.argv.slice(2);
const PANELS = wanted.length > 0 ? wanted : ['none', 'view', 'light', 'section', 'materials', 'measure', 'notes', 'film', 'compare', 'share', 'statistics', 'help'];
const HASH = '#ao=0&shadows=off';

fs.mkdirSync(out, { recursive: true });
const server = await view(path.resolve(file)), name = process.env.VOXDAG_BROWSER ?? 'chromium', isFirefox = name === 'firefox';
for (const scheme of ['light', 'dark']) {
  const browser = await launch(name, ...(isFirefox ? [`layout.css.prefers-color-scheme.content-override=${scheme === 'dark' ? 0 : 1}`] : []));
  for (const [width, height] of SIZES) {
    const page = await browser.newPage(), isPhone = Math.min(width, height) < 500;
    page.setDefaultTimeout(180_000);
    // Puppeteer cannot make a phone of Firefox: there it is a small window.
    await page.setViewport(isFirefox ? { width, height } : { width, height, isMobile: isPhone, hasTouch: isPhone });
    if (!isFirefox) await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: scheme }]);
    await page.goto(server.url + HASH);
    await page.waitForFunction('window.voxdag?.viewer?.info && window.voxdag.hands.isLoaded');
    // What the panels list: a section, measures and notes.
    await page.evaluate(() => {
      const { viewer } = /** @type {any} */ (window).voxdag, { low, high } = viewer.info.bounds, camera = viewer.camera();
      const middle = low.map((/** @type {number} */ x, /** @type {number} */ i) => (x + high[i]) / 2);
      viewer.set({
        section: { plane: { point: middle, normal: [0, 1, 0] } },
        measures: [{ kind: 'distance', points: [low, middle] }, { kind: 'area', points: [low, [high[0], low[1], low[2]], [high[0], low[1], high[2]]] }],
        annotations: [{ text: 'A crack in the north wall, two metres long: [report](report.pdf)', point: low, camera }, { text: 'Gate', point: middle, camera }],
        path: [{ time: 0, eye: camera.eye, target: camera.target }, { time: 2, eye: high, target: middle }],
      });
    });
    for (const panel of PANELS) {
      await page.evaluate((name) => {
        if (name !== 'none') /** @type {any} */ (window).voxdag.ui.open(name);
        else /** @type {HTMLElement | null} */ (document.querySelector('.panel:not([hidden]) header button'))?.click();
      }, panel);
      // A picture of larger pixels is enough.
      await new Promise((resolve) => setTimeout(resolve, 1500));
      await page.screenshot({ path: path.join(out, `${panel}-${width}x${height}-${scheme}.png`) });
    }
    await page.close();
  }
  await browser.close();
}
await server.close();
process.exit(0);
