/** What a page without a scene shows: where to drop a model, and scenes to click. */
import { hasProgram, run } from '../build/program.js';
import { button } from './controls.js';
import { h } from './dom.js';
import { chooseButton } from './open_file.js';

/** Procedural scenes: name, size and label. See docs/scenes.md. */
const SCENES = [['courtyard', '0.25', 'Courtyard'], ['city', '2', 'City'], ['terrain', '256', 'Mountains']];

/** Shows the start page until a scene is opened. @param {import('./interface.js').Ui} ui @param {HTMLElement} container */
export function showStartPage(ui, container) {
  const make = async (/** @type {string} */ name, /** @type {string} */ size) => {
    /** @type {File | undefined} */
    let mesh;
    const made = await ui.job('Make the scene', async ({ signal, progress }) => {
      [mesh] = (await run(['scene', name, '--size', size, '-o', `/out/${name}.ply`, '-q'], [], { signal, onProgress: progress })).files;
    });
    const main = made && mesh ? { name: mesh.name, data: mesh } : null;
    if (main) await ui.build(main, 'mesh', [main], '');
  };
  const builds = hasProgram();
  const page = h('div', { class: 'start welcome', id: 'start' },
    h('h2', {}, builds ? 'Drop a model here' : 'Drop a scene here'),
    h('p', {}, builds ? 'Meshes (OBJ, PLY, STL, OFF, GLB), voxels (.vox), point clouds, volumes and scenes (.vdag): a file, a folder or a .zip.'
      : 'A scene (.vdag) or a page with a scene (.html).'),
    h('div', { class: 'buttons' }, chooseButton(ui, 'Choose files…', { primary: true }), builds && chooseButton(ui, 'Choose a folder…', { folder: true })),
    h('p', {}, 'Nothing leaves this computer.'),
    builds && h('p', {}, 'Or begin with one of these:'),
    builds && h('div', { class: 'buttons' }, ...SCENES.map(([name, size, label]) => button(label, () => make(name, size)))));
  document.getElementById('start')?.remove();
  container.append(page);
  container.classList.add('empty');
  const end = () => {
    page.remove();
    container.classList.remove('empty');
    ui.viewer.off('opened', end);
  };
  ui.viewer.on('opened', end);
}
