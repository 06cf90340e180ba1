/** Starts browsers, and opens pages whose complaints are failures. */
import assert from 'node:assert/strict';
import { after, before, describe } from 'node:test';
import puppeteer from 'puppeteer-core';
import { BROWSER_PATHS, isInstalled } from './browser_paths.mjs';

/** The browser to test; without VOXDAG_BROWSER all that are installed. */
const browsers = process.env.VOXDAG_BROWSER ? [process.env.VOXDAG_BROWSER] : Object.keys(BROWSER_PATHS).filter(isInstalled);

/** How long a browser may take to start, and a page for each step, on a machine that is busy. */
const MOST_MS = 180_000;

/** Starts a browser without a window. @param {string} name  chromium or firefox @param {...string} more  options of Chromium, NAME=NUMBER of Firefox's preferences */
export function launch(name, ...more) {
  if (name === 'firefox')
    return puppeteer.launch({
      browser: 'firefox', executablePath: BROWSER_PATHS.firefox, headless: true, protocolTimeout: 300_000, timeout: MOST_MS,
      extraPrefsFirefox: { 'webgl.force-enabled': true, 'webgl.disable-fail-if-major-performance-caveat': true, 'network.proxy.type': 0,
                          'security.sandbox.content.level': 0, 'gfx.webrender.software': true,
                          ...Object.fromEntries(more.map((text) => [text.split('=')[0], Number(text.split('=')[1])])) },
    });
  return puppeteer.launch({
    executablePath: BROWSER_PATHS.chromium, headless: true, protocolTimeout: 300_000, timeout: MOST_MS,
    args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync',
           '--use-angle=swiftshader', '--enable-unsafe-swiftshader', ...more],
  });
}

/**
 * Describes tests that run in each browser. `browser()` is the one that has started.
 * @param {string} title @param {(name: string, browser: () => import('puppeteer-core').Browser) => void} body
 */
export function describeInBrowsers(title, body) {
  for (const name of browsers)
    describe(`${title} in ${name}`, { timeout: 840_000 }, () => {  // before ctest's limit, so that node names the test
      /** @type {import('puppeteer-core').Browser} */
      let browser;
      before(async () => {
        browser = await launch(name);
      });
      after(() => browser?.close());
      body(name, () => browser);
    });
}

/**
 * Opens a page. `page.complaints` collects errors of scripts, of the console and of the security policy.
 * @param {import('puppeteer-core').Browser} browser @param {string} url @param {{width?: number, height?: number, ready?: string}} [options]
 */
export async function open(browser, url, { width = 320, height = 180, ready = 'window.voxdag?.viewer' } = {}) {
  const page = await browser.newPage();
  page.setDefaultTimeout(MOST_MS);
  await page.setViewport({ width, height });
  /** @type {string[]} */
  const complaints = [];
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error') complaints.push(message.text());
  });
  await page.goto(url);
  if (ready !== '') await page.waitForFunction(ready);
  return Object.assign(page, { complaints });
}

/** Asserts that a page had no errors. @param {{complaints: string[]}} page */
export function assertNoComplaints(page) {
  assert.deepEqual(page.complaints, []);
}

/** Waits until the picture is finished. @param {import('puppeteer-core').Page} page */
export async function still(page) {
  await page.evaluate(() => /** @type {any} */ (window).voxdag.viewer.whenStill());
}
