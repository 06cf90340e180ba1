/**
 * Runs one file of tests for ctest: node run.mjs FILE chromium|firefox|none. Exit status 77: skipped, with a line that
 * says why.
 */
import { spawn, spawnSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { isInstalled } from './browser_paths.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));

/** @param {string} why */
function skip(why) {
  console.log(`Skipped: ${why}`);
  process.exit(77);
}

if (!fs.existsSync(path.join(here, 'node_modules'))) skip('no node_modules in tests/browser; run `npm ci` there');
const [file, browser] = process.argv.slice(2);
if (browser !== 'none' && !isInstalled(browser)) skip(`${browser} is not installed`);
if (['build.test.mjs', 'npm.test.mjs', 'threads.test.mjs'].includes(path.basename(file)) && !fs.existsSync(path.join(process.env.VOXDAG_PAGE ?? '', 'build/voxdag.js')))
  skip('the page has no program for browsers; configure with -DVOXDAG_BROWSER_MODULE');

// Firefox finds WebGL only on a display.
let display = process.env.DISPLAY ?? '', server = null;
if (browser === 'firefox' && display === '' && spawnSync('which', ['Xvfb']).status === 0) {
  server = spawn('Xvfb', ['-displayfd', '3', '-screen', '0', '1280x1024x24', '-nolisten', 'tcp'], { stdio: ['ignore', 'ignore', 'ignore', 'pipe'] });
  const numbers = /** @type {import('node:stream').Readable} */ (server.stdio[3]);
  display = ':' + (await new Promise((resolve) => {
    numbers.on('data', (text) => resolve(String(text).trim()));
    server?.on('exit', () => resolve(''));
  }));
}
const tests = spawn(process.execPath, ['--test', '--test-reporter=spec', file], {
  cwd: here, stdio: 'inherit', env: { ...process.env, VOXDAG_BROWSER: browser, DISPLAY: display, NO_AT_BRIDGE: '1' },
});
tests.on('exit', (code) => {
  server?.kill();
  process.exit(code ?? 1);
});
