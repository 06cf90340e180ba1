/** The keys of the camera path on a line of time: each can be dragged, and a drag beside them moves the camera along. */
import { cameraAt, completeKeys, withKeyAt } from '../hands/camera_path.js';
import { clamp } from '../math.js';
import { resize, svg, update } from './dom.js';
import { makeHandle } from './overlay.js';

/** @typedef {import('../settings.js').PathKey} PathKey */

/** The part of the line behind the last key, into which it can be dragged, and seconds that an arrow key moves a key. */
const ROOM = 0.15, STEP = 0.1;

/**
 * Makes the line. `before` is called before the camera moves.
 * @param {import('./interface.js').Ui} ui @param {() => void} before
 */
export function timeLine(ui, before) {
  const { viewer } = ui;
  const keys = svg('g'), mark = svg('line', { class: 'now', y1: 3, y2: 33, visibility: 'hidden' });
  const element = svg('svg', { class: 'time-line', role: 'group', 'aria-label': 'Keys over time' },
    svg('line', { class: 'rail', x1: '0%', x2: '100%', y1: 18, y2: 18 }), mark, keys);
  const path = () => viewer.get().path;
  /** The times at the ends; they stay while something is dragged. */
  let begin = 0, span = 1, held = false;
  const measure = () => {
    const list = path();
    if (held || list.length === 0) return;
    begin = list[0].time;
    span = Math.max(list[list.length - 1].time - begin, 1) * (1 + ROOM);
  };
  // Half a handle stays free at each end.
  const percent = (/** @type {number} */ time) => `${(3 + 94 * clamp((time - begin) / span, 0, 1)).toFixed(2)}%`;
  const timeAt = (/** @type {number} */ x) => begin + span * (x / Math.max(1, element.clientWidth) - 0.03) / 0.94;
  const refresh = () => {
    const list = path();
    measure();
    resize(keys, list.length, newKey);
    list.forEach(({ time }, i) => {
      const [reach, disc] = keys.children[i].children, cx = percent(time);
      update(reach, { cx, r: clamp(170 / list.length, 5, 14) });
      update(disc, { cx, r: clamp(90 / list.length, 3.5, 7) });
      update(keys.children[i], { 'aria-valuenow': String(time), 'aria-valuetext': `${time} s` });
    });
  };
  const release = () => {
    held = false;
    refresh();
  };
  const newKey = (/** @type {number} */ i) => {
    const key = svg('g', { class: 'handle' }, svg('circle', { class: 'reach', cy: 18 }), svg('circle', { cy: 18 }));
    const move = (/** @type {number} */ time) => viewer.set({ path: withKeyAt(path(), i, Math.round(time * 100) / 100) }, 'ui');
    let from = 0;
    makeHandle(key, {
      label: `Time of key ${i + 1}`,
      start(spot) {
        held = true;
        from = path()[i].time - timeAt(spot.x);
      },
      drag: (spot) => move(timeAt(spot.x) + from),
      key: (aside, up) => move(path()[i].time + STEP * (aside + up)),
    });
    key.addEventListener('lostpointercapture', release);
    return key;
  };
  const show = (/** @type {number | null} */ time) => {
    update(mark, { visibility: time === null ? 'hidden' : 'visible' });
    if (time !== null) update(mark, { x1: percent(time), x2: percent(time) });
  };
  const scrub = (/** @type {PointerEvent} */ event) => {
    const list = completeKeys(path(), ui.home());
    if (list.length === 0) return;
    const time = clamp(timeAt(event.clientX - element.getBoundingClientRect().left), list[0].time, list[list.length - 1].time);
    show(time);
    viewer.set({ camera: cameraAt(list, time) }, 'film');
  };
  element.addEventListener('pointerdown', (event) => {
    if (event.button !== 0) return;
    before();
    element.setPointerCapture(event.pointerId);
    scrub(event);
  });
  element.addEventListener('pointermove', (event) => { if (element.hasPointerCapture(event.pointerId)) scrub(event); });
  element.addEventListener('lostpointercapture', (event) => { if (event.target === element) show(null); });
  return { element, refresh, show };
}
