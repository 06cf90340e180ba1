/** The panel "Help": every key and gesture. */
import { group } from './controls.js';
import { h } from './dom.js';

/** @type {[string, [string, string][]][]} */
const HELP = [
  ['Mouse and touch', [
    ['Drag · one finger', 'turn; look around when flying or walking'],
    ['Right drag · Shift drag · two fingers', 'move sideways'],
    ['Wheel · pinch', 'zoom to the pointer; change the speed when flying'],
    ['Three fingers', 'fly'],
    ['Long press on an icon', 'its name'],
    ['Double click', 'turn around that point'],
  ]],
  ['Move', [
    ['W A S D', 'forward, left, back, right'],
    ['Q E', 'down, up'],
    ['Arrows', 'turn'],
    ['+ −', 'closer, farther'],
    ['Shift', 'faster'],
    ['Space', 'jump, when walking'],
    ['L', 'look around without a button; Escape ends it'],
  ]],
  ['Views', [
    ['F', 'show the whole scene'],
    ['R', 'go back to the home view'],
    ['1 … 7', 'home, front, right, back, left, top, bottom'],
    ['O V G', 'orbit, fly, walk'],
  ]],
  ['Tools', [
    ['B', 'section plane'],
    ['M', 'measure'],
    ['N', 'note'],
    ['C', 'copy voxel and position under the pointer'],
    ['K', 'add a key to the camera path'],
    ['P', 'save a picture'],
    ['I', 'statistics'],
    ['H', 'this help'],
    ['Shift', 'keep a measure to an axis'],
    ['Enter', 'end a path, close an area'],
    ['Escape', 'end a tool, close a panel'],
  ]],
];

/** @param {[string, [string, string][]][]} [more]  Keys of panels that only some pages have. */
export function helpPanel(more = []) {
  return {
    element: h('div', { class: 'help' }, ...[...more, ...HELP].map(([title, rows]) =>
      group(title, h('dl', {}, ...rows.map(([keys, act]) =>
        h('div', {}, h('dt', {}, ...(/^(.|Shift|Space|Enter|Escape|Arrows|[A-Z](?: [A-Z])+|\+ −|1 … 7)$/.test(keys)
          ? (/^[A-Z+](?: .)+$/.test(keys) ? keys.split(' ') : [keys]).map((key) => h('kbd', {}, key)) : [keys])), h('dd', {}, act)))))),
    h('p', { class: 'hint' }, 'A gamepad works too: sticks move and turn, triggers zoom, Y frames, X changes the mode, B goes home.')),
    refresh() {},
  };
}
