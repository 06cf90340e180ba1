/** The colours of a picture of the structure: a bar with the values at its ends. */
import { scaleColor } from '../gpu/color_scale.js';
import { h, say } from './dom.js';
import { countText, valueText } from './numbers.js';

/**
 * @typedef {import('../viewer_types.js').Viewer} Viewer
 * @typedef {import('../settings.js').Show} Show
 */

const STOPS = 16;

/**
 * Returns what stands at the dark and at the bright end.
 * @param {Show} show @param {[number, number]} range  Of Viewer.shownRange(). @returns {[string, string]}
 */
export function endLabels(show, [least, most]) {
  if (show === 'level') return [`level ${least}`, `level ${most}`];
  if (show === 'steps') return [`${least} steps`, `${most} or more`];
  return [`used ${countText(2 ** least)}×`, `${countText(2 ** most)}×`];
}

/** Returns the colours as an image of CSS. @param {Show} show */
export const gradient = (show) => `linear-gradient(to right, ${Array.from({ length: STOPS }, (_, i) =>
  `rgb(${scaleColor(show, i / (STOPS - 1)).map((x) => Math.round(255 * x)).join(' ')})`).join(', ')})`;

/** Returns the colours of a channel, at equal distances. @param {number[][]} colors */
export const channelGradient = (colors) => `linear-gradient(to right, ${colors.map((color) => `rgb(${color.join(' ')})`).join(', ')})`;

/** @param {Viewer} viewer */
export function legend(viewer) {
  const name = h('strong'), least = h('span'), bar = h('i'), most = h('span');
  const element = h('div', { class: 'legend', hidden: true }, name, least, bar, most);
  const refresh = () => {
    const { show } = viewer.get(), channel = show === 'light' ? viewer.channel() : null, range = channel?.range ?? viewer.shownRange();
    element.hidden = range === null;
    name.hidden = channel === null;
    if (range === null) return;
    const [low, high] = channel ? range.map(valueText) : endLabels(show, range);
    say(name, channel?.name ?? '');
    say(least, low);
    say(most, high);
    bar.style.backgroundImage = channel ? channelGradient(channel.colors) : gradient(show);
  };
  for (const event of ['info', 'level', 'channel']) viewer.on(event, refresh);
  viewer.on('settings', (_, by) => { if (by !== 'hands' && by !== 'film') refresh(); });
  return element;
}
