import assert from 'node:assert/strict';
import { test } from 'node:test';

import { embedCode, whyNotShared, withoutSecret } from '../../apps/viewer/page/ui/link_reach.js';

test('a link that others cannot open says why', () => {
  for (const address of ['http://127.0.0.1:8080/#a', 'http://localhost/', 'https://scene.localhost/', 'http://[::1]:80/', 'http://0.0.0.0/'])
    assert.match(whyNotShared(address), /this computer/, address);
  assert.match(whyNotShared('file:///home/me/scene.html#eye=1,2,3'), /file on this computer/);
  for (const address of ['blob:https://example.org/1-2', 'about:srcdoc', 'data:text/html,x']) assert.match(whyNotShared(address), /no address/, address);
  for (const address of ['http://192.168.1.4:8000/', 'http://10.0.0.1/', 'http://172.20.0.1/', 'http://nas.local/', 'http://[fd00::1]/'])
    assert.match(whyNotShared(address), /network/, address);
  for (const address of ['https://example.org/scene.html#eye=1,2,3', 'http://172.32.0.1/', 'http://11.0.0.1/', 'https://locals.example/', 'http://[2001:db8::1]/'])
    assert.equal(whyNotShared(address), '', address);
});

test('the code for another page escapes what could end an attribute', () => {
  const code = embedCode('https://example.org/a?b=1&c="2"#note=<x>', 'A "scene" & <more>');
  assert.match(code, /^<iframe src="https:\/\/example\.org\/a\?b=1&#38;c=&#34;2&#34;#note=&#60;x&#62;" title="A &#34;scene&#34; &#38; &#60;more&#62;" .*><\/iframe>$/);
});

test('links do not have the secret of edits', () => {
  assert.equal(withoutSecret('http://localhost:8080/?edit=abc'), 'http://localhost:8080/');
  assert.equal(withoutSecret('http://localhost:8080/?a=1&edit=abc'), 'http://localhost:8080/?a=1');
  assert.equal(withoutSecret('https://example.org/scene.html'), 'https://example.org/scene.html');
});
