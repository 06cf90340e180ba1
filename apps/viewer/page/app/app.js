/** The page's program: a viewer of the scene beside the page, with hands and interface. */
import { Hands } from '../hands/hands.js';
import { settingsFromHash } from '../settings.js';
import { createInterface } from '../ui/interface.js';
import { capitalized, keepLink } from '../ui/link.js';
import { failureCard, tryAgain } from '../ui/status.js';
import { createViewer } from '../viewer.js';

const container = /** @type {HTMLElement} */ (document.getElementById('viewer'));

/** @param {unknown} error */
function showFailure(error) {
  document.getElementById('start')?.remove();
  const message = error instanceof Error ? error.message : String(error);
  const noGraphics = !document.createElement('canvas').getContext('webgl2');
  container.append(noGraphics
    ? failureCard('This browser has no WebGL 2', 'The viewer draws with WebGL 2. Switch on hardware acceleration in the settings of the browser, update the browser or the graphics driver, or open the page in another browser.', [tryAgain()])
    : failureCard('The viewer cannot start', message, [tryAgain()]));
  container.classList.add('failed');
}

try {
  const { settings, problems } = settingsFromHash(location.hash);
  const viewer = createViewer({ container, settings });
  const hands = new Hands(viewer);
  const { ui } = createInterface(viewer, hands, container);
  keepLink(ui);
  for (const problem of problems) console.warn(problem);
  if (problems.length) ui.toast(capitalized(problems[0]), true);
  // For tests and for the console.
  Object.assign(window, { voxdag: { viewer, hands, ui } });
} catch (error) {
  console.error(error);
  showFailure(error);
}
