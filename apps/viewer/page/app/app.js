/** The page's program: a viewer of the scene beside the page, with hands and interface. */
import { bakedSettings } from '../baked_settings.js';
import { hasProgram } from '../build/program.js';
import { hasNoScene } from '../file/byte_source.js';
import { Hands } from '../hands/hands.js';
import { settingsFromHash } from '../settings_link.js';
import { createInterface } from '../ui/interface.js';
import { capitalized, keepLink } from '../ui/link.js';
import { openFiles } from '../ui/open_file.js';
import { showStartPage } from '../ui/start_page.js';
import { failureCard, tryAgain } from '../ui/status.js';
import { createViewer } from '../viewer.js';

const container = /** @type {HTMLElement} */ (document.getElementById('container'));
const picture = /** @type {HTMLElement} */ (document.getElementById('picture'));

try {
  const { base, problem } = bakedSettings(), { settings, problems } = settingsFromHash(location.hash, base);
  if (problem) problems.unshift(problem);
  const query = new URLSearchParams(location.search), url = query.get('url'), empty = url !== null || hasNoScene();
  // `voxdag view --edit` prints an address with a secret, and sends edit/. The program can edit, too. The page waits for
  // edit/ here: nothing may wait between the viewer and the interface, which hears the viewer's first failure.
  const secret = query.get('edit'), edits = secret !== null || hasProgram() ? await import('../edit/editing.js').catch(() => null) : null;
  const viewer = createViewer({ container: picture, settings, empty });
  const hands = new Hands(viewer);
  if (secret !== null && edits === null) problems.push('this page cannot edit: use the address that `voxdag view --edit` prints');
  const ui = createInterface(viewer, hands, container, base, edits && ((ui) => edits.makeEditing(ui, secret)));
  keepLink(ui, base);
  for (const problem of problems) console.warn(problem);
  if (problems.length) ui.toast(capitalized(problems[0]), true);
  if (empty) showStartPage(ui, container);
  if (url !== null) openAddress(ui, url);
  // For tests and for the console.
  Object.assign(window, { voxdag: { viewer, hands, ui } });
} catch (error) {
  console.error(error);
  document.getElementById('start')?.remove();
  container.append(failureCard('The viewer cannot start', error instanceof Error ? error.message : String(error), [tryAgain()]));
}

/** Opens a file of the page's host. @param {ReturnType<typeof createInterface>} ui @param {string} url */
async function openAddress(ui, url) {
  const name = decodeURIComponent(url.replace(/[?#].*/, '').replace(/^.*\//, ''));
  try {
    const response = await fetch(new URL(url, document.baseURI));
    if (!response.ok) throw new Error(`the server answers ${response.status}`);
    await openFiles(ui, [{ name, data: await response.blob() }]);
  } catch (error) {
    ui.toast(`${url}: ${error instanceof TypeError ? 'cannot be loaded: a page loads files of its own host only' : /** @type {Error} */ (error).message}`, true);
  }
}
