/** The panel "Notes": texts at points of the scene; each remembers the camera that shows it. */
import { addScaled, distance, normalized, roundTo3, stepBelow, sub } from '../math.js';
import { roundCamera } from '../hands/pose.js';
import { button, group } from './controls.js';
import { h, resize, say, svg, update } from './dom.js';
import { place } from './overlay.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../settings.js').Settings} Settings
 * @typedef {import('../settings.js').Annotation} Annotation
 */

/** @param {Ui} ui */
export function notesPanel(ui) {
  const { viewer, overlay, hands } = ui;
  const layer = svg('g', {});
  /** @type {{element: SVGGElement, number: SVGTextElement, text: SVGTextElement}[]} */
  const markers = [];
  const newMarker = (/** @type {number} */ i) => {
    const number = svg('text', { class: 'number', 'text-anchor': 'middle', dy: '0.35em' }, String(i + 1));
    const text = svg('text', { class: 'label', x: 18, dy: '0.35em' });
    const element = svg('g', {
      class: 'marker', tabindex: 0, role: 'button',
      on: {
        click: () => go(i),
        pointerdown: (event) => event.stopPropagation(),
        keydown: (event) => { if (event.key === 'Enter' || event.key === ' ') { event.preventDefault(); go(i); } },
      },
    }, svg('circle', { class: 'reach', r: 18 }), svg('circle', { class: 'disc', r: 11 }), number, text);
    layer.append(element);
    return { element, number, text };
  };
  const go = (/** @type {number} */ i) => {
    const note = viewer.get().annotations[i];
    if (!note) return;
    hands.flyTo(note.camera);
    ui.announce(note.text);
  };
  const lineOf = (/** @type {string} */ text) => {
    const line = text.split('\n')[0];
    return line.length > 40 ? line.slice(0, 39) + '…' : line;
  };
  overlay.add((projection, { annotations }) => {
    while (markers.length < annotations.length) markers.push(newMarker(markers.length));
    markers.forEach(({ element, text }, i) => {
      const note = annotations[i], spot = note ? projection.at(note.point) : null;
      place(element, spot);
      if (!note || !spot) return;
      // A marker behind a surface is pale.
      const way = sub(note.point, projection.camera.eye), away = distance(note.point, projection.camera.eye);
      const hit = viewer.castNow(projection.camera.eye, normalized(way), away);
      element.classList.toggle('hidden-point', hit !== null && hit.distance < away - 3 * (viewer.info?.voxelSize ?? 0) - away * 1e-3);
      say(text, lineOf(note.text));
      update(element, { 'aria-label': `Note ${i + 1}: ${note.text}` });
    });
  }, layer);

  const tool = ui.tool({
    hint: () => 'Click the place of the note',
    click(hit) {
      const camera = roundCamera(viewer.camera()), { annotations } = viewer.get();
      // A little towards the viewer, so that the marker is not in the surface.
      const out = addScaled(hit.position, normalized(sub(camera.eye, hit.position)), (viewer.info?.voxelSize ?? 0) * 0.5);
      const note = { text: `Note ${annotations.length + 1}`, point: roundTo3(out, stepBelow(viewer.info?.voxelSize ?? 1, 0.01)), camera };
      tool.stop();
      viewer.set({ annotations: [...annotations, note] }, 'ui');
      ui.open('notes');
      const area = /** @type {HTMLTextAreaElement | null} */ (list.querySelector('li:last-child textarea'));
      area?.focus();
      area?.select();
    },
  });
  const start = button('Add a note', () => tool.toggle(),
    { icon: 'add', primary: true, title: 'Click a point of the scene (key N)', keys: 'N' });
  const list = h('ul', { class: 'list notes' });
  const change = (/** @type {number} */ i, /** @type {Partial<Annotation>} */ part) =>
    viewer.set({ annotations: viewer.get().annotations.map((note, k) => (k === i ? { ...note, ...part } : note)) }, 'ui');
  const newItem = (/** @type {number} */ i) => {
    const area = h('textarea', {
      rows: 2, 'aria-label': `Text of note ${i + 1}`, maxlength: 2000, on: { input: () => change(i, { text: area.value }) },
    });
    const remove = () => viewer.set({ annotations: viewer.get().annotations.filter((_, k) => k !== i) }, 'ui');
    return h('li', {}, h('span', { class: 'badge', 'aria-hidden': 'true' }, String(i + 1)), area,
      h('span', { class: 'stack' },
        button(`Fly to note ${i + 1}`, () => go(i), { icon: 'fly', bare: true }),
        button(`Let note ${i + 1} remember this view`, () => {
          change(i, { camera: roundCamera(viewer.camera()) });
          ui.toast('The note remembers this view');
        }, { icon: 'camera', bare: true }),
        button(`Delete note ${i + 1}`, remove, { icon: 'trash', bare: true })));
  };
  return {
    element: h('div', {}, group('', start), list,
      h('p', { class: 'hint' },
        'A click on a marker flies to the view in which the note was written. Notes are part of the link and of saved settings.')),
    refresh(/** @type {Settings} */ { annotations }) {
      start.setAttribute('aria-pressed', String(tool.active));
      resize(list, annotations.length, newItem);
      annotations.forEach((note, i) => {
        const area = list.children[i].querySelector('textarea');
        if (area && area.value !== note.text) area.value = note.text;
      });
    },
    tool,
  };
}
