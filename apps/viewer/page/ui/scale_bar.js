/** A bar that shows how long a length is in the picture, in the depth of its middle, and the scale 1:n. */
import { distance } from '../math.js';
import { METRES, roundBelow, unitFactor } from '../measures.js';
import { h, say } from './dom.js';
import { countText } from './numbers.js';

/** The bar is at most so long, in pixels; and metres of a CSS pixel. */
const MOST = 130, PIXEL = 0.0254 / 96;

/**
 * Returns the length of the bar in the shown unit, its pixels, and n of the scale, or null without a unit.
 * @param {number} pixel  World units of a pixel. @param {import('../settings.js').Unit | null} own  Of the world. @param {import('../settings.js').Unit | null} shown
 */
export function scaleOf(pixel, own, shown) {
  const factor = unitFactor(own, shown), size = roundBelow(MOST * pixel * factor);
  return { size, pixels: size / factor / pixel, ratio: own ? pixel * METRES[own] / PIXEL : null };
}

/** @param {import('./interface.js').Ui} ui @param {HTMLElement} container @param {() => boolean} isWanted */
export function scaleBar(ui, container, isWanted) {
  const bar = h('i'), label = h('span');
  const element = h('div', { class: 'scale', hidden: true, title: 'Holds in the depth of the middle of the picture, on a screen with 96 pixels per inch' }, bar, label);
  container.append(element);
  ui.overlay.add((projection) => {
    const { info } = ui.viewer;
    element.hidden = !info || !isWanted();
    if (!info || element.hidden) return;
    const { camera } = projection, pixel = 2 * projection.lens.tanY * distance(camera.target, camera.eye) / projection.height;
    const unit = ui.viewer.get().unit ?? info.unit, { size, pixels, ratio } = scaleOf(pixel, info.unit, unit);
    bar.style.width = `${pixels}px`;
    const scale = ratio === null ? '' : ratio >= 1 ? ` · 1:${countText(Number(ratio.toPrecision(2)))}` : ` · ${countText(Number((1 / ratio).toPrecision(2)))}:1`;
    say(label, `${size} ${info.unit ? unit : ''}`.trim() + scale);
  });
}
