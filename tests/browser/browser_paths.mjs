/** Where Debian installs the browsers. */
import fs from 'node:fs';

/** @type {Record<string, string>} */
export const BROWSER_PATHS = { chromium: '/usr/bin/chromium', firefox: '/usr/bin/firefox-esr' };

/** @param {string} name */
export const isInstalled = (name) => fs.existsSync(BROWSER_PATHS[name]);
