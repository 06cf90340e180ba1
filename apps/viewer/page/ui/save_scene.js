/** Buttons that save the scene as a file, in the panel "Save and share". */
import { hasProgram, run } from '../build/program.js';
import { isSinglePage, pageWith } from '../build/single_page.js';
import { Zip } from '../file/zip.js';
import { settingsToJson } from '../settings.js';
import { button, group } from './controls.js';
import { download, h } from './dom.js';

/** @param {import('./interface.js').Ui} ui */
export function saveScene(ui) {
  const { viewer } = ui;
  const save = (/** @type {string} */ extension) => ui.job('Save', async ({ signal, progress }) => {
    const scene = await ui.scene(), name = ui.name(), file = `${name}.${extension}`;
    if (extension === 'vdag') return download(file, scene);
    if (extension === 'html') return download(file, await pageWith(scene, document.title, settingsToJson({ ...viewer.get(), camera: viewer.camera() })));
    const { files } = await run(['export', `/in/${name}.vdag`, '-o', `/out/${file}`, '--json'], [{ name: `${name}.vdag`, data: scene }], { signal, onProgress: progress });
    if (files.length === 1) return download(file, files[0]);
    // FILE.json, beside a .vox or .stl, tells where its voxels lie.
    const zip = new Zip();
    for (const part of files) await zip.add(part.name, part);
    download(`${file}.zip`, zip.finish());
  });
  const kinds = ['vdag', ...(isSinglePage() || hasProgram() ? ['html'] : []), ...(hasProgram() ? ['vox', 'glb', 'stl'] : [])];
  return group('Save the scene', h('div', { class: 'buttons' }, ...kinds.map((kind) => button(`.${kind}`, () => save(kind), { title: `Save the scene as .${kind}` }))));
}
