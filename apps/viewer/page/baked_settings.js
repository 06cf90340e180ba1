/** The settings that `voxdag export --view` or `voxdag view --view` put into the page. */
import { DEFAULTS, SettingsError, settingsFromJson } from './settings.js';

/** Returns the settings that the page begins with, and what is wrong with them. @returns {{base: import('./settings.js').Settings, problem: string | null}} */
export function bakedSettings() {
  const element = document.querySelector('script[type="application/json"]#settings');
  try {
    return { base: element === null ? DEFAULTS : settingsFromJson(element.textContent ?? ''), problem: null };
  } catch (error) {
    if (!(error instanceof SettingsError)) throw error;
    return { base: DEFAULTS, problem: `the page's settings are left out: ${error.message}` };
  }
}
