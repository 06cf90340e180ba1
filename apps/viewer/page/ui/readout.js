/** Shows the voxel under the pointer and its position, in a corner of the picture. */
import { roundTo3, stepBelow } from '../math.js';
import { copy, h, say } from './dom.js';
import { materialName } from './materials_panel.js';
import { lengthText, valueText } from './numbers.js';

/**
 * @typedef {import('./interface.js').Ui} Ui
 * @typedef {import('../viewer_types.js').Hit} Hit
 */

export class Readout {
  /** @param {Ui} ui @param {HTMLElement} container */
  constructor(ui, container) {
    this.ui = ui;
    this.voxel = h('span', { class: 'voxel' });
    this.position = h('span', { class: 'position' });
    this.element = h('div', { class: 'readout', hidden: true, title: 'C copies this' }, this.voxel, this.position);
    container.append(this.element);
    /** @type {Hit | null} */
    this.hit = null;
    /** @type {{x: number, y: number} | null} */
    this.wanted = null;
    this.busy = false;
    /** @type {(hit: Hit | null, x: number, y: number) => void} */
    this.onHit = () => {};
  }

  /** Picks at a pixel, one pick at a time: the last pixel counts. @param {number} x @param {number} y @param {boolean} [tapped] */
  async look(x, y, tapped = false) {
    this.wanted = { x, y };
    if (this.busy) return;
    this.busy = true;
    try {
      while (this.wanted) {
        const at = this.wanted;
        this.wanted = null;
        const hit = await this.ui.viewer.pick(at.x, at.y);
        this.#show(hit);
        this.onHit(hit, at.x, at.y);
      }
      if (tapped && this.hit) this.ui.announce(this.#words(this.hit).join(', '));
    } finally {
      this.busy = false;
    }
  }

  /** Shows nothing. */
  clear() {
    this.wanted = null;
    this.#show(null);
  }

  /** Returns the two lines that are shown. @param {Hit} hit */
  #words(hit) {
    const { info } = this.ui.viewer, step = (info?.voxelSize ?? 1) * 0.1;
    const level = info && hit.level < info.levels ? ` · level ${hit.level}` : '';
    const id = info?.materials ? this.ui.viewer.material(hit) : null;
    const material = info?.materials && id !== null ? ` · ${materialName(info.materials, id)}` : '';
    const channel = this.ui.viewer.channel(), value = this.ui.viewer.channelValue(hit);
    const shown = channel && value !== null ? ` · ${channel.name} ${valueText(value)}` : '';
    return [`voxel ${hit.voxel.join(' ')}${level}${material}${shown}`, hit.position.map((x) => lengthText(x, step)).join('  ')];
  }

  /** @param {Hit | null} hit */
  #show(hit) {
    this.hit = hit;
    this.element.hidden = !hit;
    if (!hit) return;
    const [voxel, position] = this.#words(hit);
    say(this.voxel, voxel);
    say(this.position, position);
  }

  /** Copies the voxel under the pointer and its position. */
  async copy() {
    const { hit } = this;
    if (!hit) return this.ui.toast('Nothing is under the pointer');
    const position = roundTo3(hit.position, stepBelow(this.ui.viewer.info?.voxelSize ?? 1, 0.01));
    const text = `voxel ${hit.voxel.join(' ')} level ${hit.level} position ${position.join(' ')}`;
    this.ui.toast((await copy(text)) ? 'Voxel and position copied' : 'The browser did not allow copying');
  }
}
