/** The panel "Notes": texts at points of the scene; each remembers the camera that shows it. */
import { addScaled, distance, normalized, roundTo3, stepBelow, sub } from '../math.js';
import { roundCamera } from '../hands/pose.js';
import { partsOf, plainText, wrapped } from '../rich_text.js';
import { keeps } from '../section_ray.js';
import { button, group } from './controls.js';
import { h, resize, svg, update } from './dom.js';
import { place } from './overlay.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../settings.js').Settings} Settings
 * @typedef {import('../settings.js').Annotation} Annotation
 */

/** Characters of a line of a label, and its lines; the distance of lines, in em. */
const LINE = 34, LINES = 4, LEADING = 1.25;

/** Returns the elements of a text with links and images: texts become texts, never HTML. @param {string} text */
export function richText(text) {
  return partsOf(text).map(({ kind, text: name, address }) => (kind === 'text' ? name
    : kind === 'image' ? h('img', { src: address, alt: name, loading: 'lazy' })
      : h('a', { href: address, target: '_blank', rel: 'noopener noreferrer' }, name)));
}

/** @param {Ui} ui */
export function notesPanel(ui) {
  const { viewer, overlay, hands } = ui;
  const layer = svg('g', {});
  /** @type {{element: SVGGElement, number: SVGTextElement, text: SVGTextElement}[]} */
  const markers = [];
  const newMarker = (/** @type {number} */ i) => {
    const number = svg('text', { class: 'number', 'text-anchor': 'middle', dy: '0.35em' }, String(i + 1));
    const text = svg('text', { class: 'label' });
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
    ui.announce(plainText(note.text));
  };
  /** Writes the lines of a label beside the middle of its marker. @param {SVGTextElement} label @param {string} text */
  const write = (label, text) => {
    if (label.getAttribute('data-text') === text) return;
    label.setAttribute('data-text', text);
    const lines = wrapped(plainText(text), LINE, LINES);
    label.replaceChildren(...lines.map((line, i) => svg('tspan', { x: 18, dy: `${i === 0 ? 0.35 - (lines.length - 1) * LEADING / 2 : LEADING}em` }, line)));
  };
  overlay.add((projection, { annotations, section }) => {
    while (markers.length < annotations.length) markers.push(newMarker(markers.length));
    markers.forEach(({ element, text }, i) => {
      const note = annotations[i], spot = note ? projection.at(note.point) : null;
      place(element, spot);
      if (!note || !spot) return;
      // A marker behind a surface is pale.
      const way = sub(note.point, projection.camera.eye), away = distance(note.point, projection.camera.eye);
      const hit = viewer.castNow(projection.camera.eye, normalized(way), away);
      element.classList.toggle('hidden-point', hit !== null && hit.distance < away - 3 * (viewer.info?.voxelSize ?? 0) - away * 1e-3);
      element.classList.toggle('cut-away', !keeps(section, note.point, 2 * (viewer.info?.voxelSize ?? 0)));
      write(text, note.text);
      update(element, { 'aria-label': `Note ${i + 1}: ${plainText(note.text)}` });
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
      edit(annotations.length);
    },
  });
  const start = button('Add a note', () => tool.toggle(),
    { icon: 'add', primary: true, title: 'Click a point of the scene (key N)', keys: 'N' });
  const list = h('ul', { class: 'list notes' });
  const change = (/** @type {number} */ i, /** @type {Partial<Annotation>} */ part) =>
    viewer.set({ annotations: viewer.get().annotations.map((note, k) => (k === i ? { ...note, ...part } : note)) }, 'ui');
  /** The note that is being written; -1: none. */
  let edited = -1;
  /** Opens the text of a note. @param {number} i */
  const edit = (i) => {
    edited = i;
    ui.refresh();
    const area = list.children[i]?.querySelector('textarea');
    area?.focus();
    area?.select();
  };
  const newItem = (/** @type {number} */ i) => {
    const ended = () => {
      if (edited === i) edited = -1;
      ui.refresh();
    };
    const area = h('textarea', {
      rows: 3, 'aria-label': `Text of note ${i + 1}`, maxlength: 2000, enterkeyhint: 'done', on: {
        input: () => change(i, { text: area.value }),
        blur: ended,
        keydown: (event) => {
          if (event.isComposing || !(event.key === 'Escape' || (event.key === 'Enter' && !event.shiftKey))) return;
          event.preventDefault();
          event.stopPropagation();
          ended();
          /** @type {HTMLElement | null} */ (list.children[i]?.querySelector('.edit'))?.focus();
        },
      },
    });
    const body = h('div', { class: 'note-text', on: { click: (event) => { if (!event.target.closest('a')) edit(i); } } });
    const remove = () => viewer.set({ annotations: viewer.get().annotations.filter((_, k) => k !== i) }, 'ui');
    return h('li', {}, h('span', { class: 'badge', 'aria-hidden': 'true' }, String(i + 1)), area, body,
      h('span', { class: 'stack' },
        button(`Fly to note ${i + 1}`, () => go(i), { icon: 'fly', bare: true }),
        button(`Store this view in note ${i + 1}`, () => {
          change(i, { camera: roundCamera(viewer.camera()) });
          ui.toast('The note shows this view from now on');
        }, { icon: 'camera', bare: true }),
        Object.assign(button(`Write note ${i + 1}`, () => edit(i), { icon: 'pen', bare: true }), { className: 'bare edit' }),
        button(`Delete note ${i + 1}`, remove, { icon: 'trash', bare: true })));
  };
  return {
    element: h('div', {}, group('', start), list,
      h('p', { class: 'hint' },
        'Enter ends a note; Shift and Enter together begin a new line. ', h('code', {}, '[text](address)'), ' is a link, ', h('code', {}, '![text](picture.png)'),
        ' a picture. A click on a marker flies to the view of its note. Notes are part of the link and of saved settings.')),
    refresh(/** @type {Settings} */ { annotations }) {
      start.setAttribute('aria-pressed', String(tool.active));
      resize(list, annotations.length, newItem);
      annotations.forEach((note, i) => {
        const item = list.children[i], area = item.querySelector('textarea'), body = /** @type {HTMLElement} */ (item.querySelector('.note-text'));
        if (!area) return;
        if (area.value !== note.text) area.value = note.text;
        area.hidden = i !== edited;
        body.hidden = i === edited;
        if (body.dataset.text === note.text) return;
        body.dataset.text = note.text;
        body.replaceChildren(...richText(note.text));
      });
    },
    tool,
  };
}
