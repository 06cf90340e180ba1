import assert from 'node:assert/strict';
import { test } from 'node:test';

import { partsOf, plainText, safeAddress, wrapped } from '../../apps/viewer/page/rich_text.js';
import { randomNumbers } from './random.mjs';

const png = 'data:image/png;base64,iVBORw0KGgo=';

test('links and images of a note are found', () => {
  assert.deepEqual(partsOf('see [the plan](plan.pdf), https://example.org/a?b=1. ![door](door.png)'), [
    { kind: 'text', text: 'see ', address: '' }, { kind: 'link', text: 'the plan', address: 'plan.pdf' }, { kind: 'text', text: ', ', address: '' },
    { kind: 'link', text: 'example.org/a?b=1', address: 'https://example.org/a?b=1' }, { kind: 'text', text: '. ', address: '' },
    { kind: 'image', text: 'door', address: 'door.png' }]);
  assert.deepEqual(partsOf(`![](${png})`), [{ kind: 'image', text: png, address: png }]);
  assert.deepEqual(partsOf('![x](https://example.org/x.png)'), [{ kind: 'link', text: 'x', address: 'https://example.org/x.png' }]);
  assert.deepEqual(partsOf(''), []);
  assert.equal(plainText('a [b](c) ![d](e.png)'), 'a b [d]');
});

test('hostile texts stay plain text', () => {
  const hostile = [
    '<img src=x onerror=alert(1)>', '<script>alert(1)</script>', '[x](javascript:alert)', '[x](JaVaScRiPt:alert)', '[x](java\tscript:alert)',
    '[x](\u0001javascript:alert)', '[x](vbscript:a)', '[x](data:text/html,<script>)', '![x](data:image/svg+xml;base64,PHN2Zz4=)', '![x](data:text/html;base64,AAAA)',
    `[x](${png})`, '[x](//evil.example)', '[x](\\\\evil.example)', '[x](http://example.org)', '[x](file:///etc/passwd)', '[x](blob:https://a)', '![x](javascript:1)',
    '[x](https://)', '[x](mailto:a@b)', 'http://example.org', '[x](%6aavascript:alert)',
  ];
  for (const text of hostile) {
    const parts = partsOf(text);
    assert.ok(parts.every(({ kind }) => kind === 'text'), `${text}: ${JSON.stringify(parts)}`);
    assert.equal(parts.map((part) => part.text).join(''), text);
  }
});

test('random marks never give an address that is not safe', () => {
  const random = randomNumbers(3), pieces = ['[', ']', '(', ')', '!', 'javascript:', 'data:image/png;base64,', 'https://', '//', 'x', ' ', '\n', '<b>', '"', "'", '\\', ':', '/', '#', '?', '&#58;', '\u0000'];
  for (let i = 0; i < 20000; ++i) {
    let text = '';
    for (let n = 1 + random() * 14; n > 0; --n) text += pieces[Math.floor(random() * pieces.length)];
    for (const { kind, address } of partsOf(text)) {
      if (kind === 'text') continue;
      const url = new URL(address, 'https://base.example/folder/page.html');  // throws for one that is none
      assert.ok(url.protocol === 'https:' || (kind === 'image' && url.protocol === 'data:'), `${text} -> ${address}`);
      if (url.host !== 'base.example') assert.ok(/^https:\/\//.test(address) && kind === 'link', `${text} -> ${address}`);
      assert.equal(safeAddress(address, kind === 'image'), address);
    }
  }
});

test('long labels wrap between words', () => {
  assert.deepEqual(wrapped('one two three four', 9, 3), ['one two', 'three', 'four']);
  assert.deepEqual(wrapped('abcdefghijkl', 5, 3), ['abcde', 'fghij', 'kl']);
  assert.deepEqual(wrapped('a\nb', 5, 3), ['a', 'b']);
  assert.deepEqual(wrapped('one two three four', 9, 2), ['one two', 'three…']);
  assert.deepEqual(wrapped('', 9, 2), ['']);
  assert.deepEqual(wrapped('🙂🙂🙂', 2, 2), ['🙂🙂', '🙂']);
  const random = randomNumbers(9);
  for (let i = 0; i < 2000; ++i) {
    const text = Array.from({ length: Math.floor(random() * 80) }, () => ' \nabcdé'[Math.floor(random() * 7)]).join('');
    const lines = wrapped(text, 10, 3);
    assert.ok(lines.length >= 1 && lines.length <= 3 && lines.every((line) => Array.from(line).length <= 10), JSON.stringify([text, lines]));
  }
});
