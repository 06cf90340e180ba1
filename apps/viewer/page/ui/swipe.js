/** A layer over the picture that is cut off at a line, which can be dragged. */
import { clamp } from '../math.js';
import { h, say } from './dom.js';
import { makeHandle } from './overlay.js';

/** @typedef {'both' | 'first' | 'second'} Shown */

/** The part of the width that an arrow key moves the line. */
const STEP = 0.02;

/** Returns the clip path of the layer, which is right of the line. @param {Shown} shown @param {number} part  Of the width: 0 to 1. */
export const clipOf = (shown, part) =>
  `inset(0 0 0 ${shown === 'first' ? 100 : shown === 'second' ? 0 : +(100 * clamp(part, 0, 1)).toFixed(3)}%)`;

/** Adds the layer over a canvas. @param {HTMLCanvasElement} canvas */
export function swipe(canvas) {
  const layer = h('div', { class: 'second', hidden: true }), names = [h('span', {}), h('span', {})];
  const line = h('div', { class: 'divider', hidden: true }, ...names, h('i', {}));
  canvas.after(layer, line);
  let part = 0.5;
  /** @type {Shown} */
  let shown = 'first';
  const draw = () => {
    layer.style.clipPath = clipOf(shown, part);
    line.style.left = `${100 * part}%`;
    line.setAttribute('aria-valuenow', String(Math.round(100 * part)));
  };
  const move = (/** @type {number} */ to) => {
    part = clamp(to, 0, 1);
    draw();
  };
  makeHandle(line, {
    label: 'Line between the scenes, percent of the width',
    start() {},
    drag({ x }) {
      const { left, width } = canvas.getBoundingClientRect();
      move((x - left) / Math.max(1, width));
    },
    key: (aside, up) => move(part + STEP * (aside + up)),
  });
  return {
    layer,
    /** @param {Shown} what @param {[string, string]} texts  The names beside the line. */
    show(what, texts) {
      shown = what;
      texts.forEach((text, i) => say(names[i], text));
      layer.hidden = what === 'first';
      line.hidden = what !== 'both';
      draw();
    },
  };
}
