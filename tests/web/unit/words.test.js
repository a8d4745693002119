import assert from 'node:assert/strict';
import { after, before, beforeEach, test } from 'node:test';
import { words } from '../../../web-client/panels/controls.js';
import { replaceGlobals } from './fakes.js';

const settled = () => new Promise(setImmediate);

let giveBack;
let page;

before(() => {
  giveBack = replaceGlobals({ document: { createElement: () => ({ value: '', append() {} }) } });
});
after(() => giveBack());

beforeEach(() => {
  page = { sent: [] };
  page.control = words({}, 10, (text) => new Promise((resolve) => { page.sent.push({ text, resolve }); }));
  page.area = page.control.element;
  page.type = (text) => {
    page.area.value = text;
    page.area.oninput();
  };
  page.texts = () => page.sent.map(({ text }) => text);
});

test('it shows what the server has, also while it has the focus', () => {
  for (const text of ['a', 'b\nc', '']) {
    page.control.show(text);
    assert.equal(page.area.value, text);
  }
});

test('what is typed and not sent stays, whatever comes', () => {
  page.control.show('a');
  page.type('a b');
  page.control.show('a');
  page.control.show('other');
  assert.equal(page.area.value, 'a b');
  page.area.onblur();
  assert.deepEqual(page.texts(), ['a b']);
  page.control.show('a b');
  page.control.show('c');
  assert.equal(page.area.value, 'c');
});

test('it is sent once when it is left, and again where the server does not have it', async () => {
  page.control.show('a');
  page.area.onblur();
  page.type('b');
  page.area.onchange();
  page.area.onblur();
  assert.deepEqual(page.texts(), ['b']);
  page.sent[0].resolve(); // refused, as there is no connection
  await settled();
  page.control.show('a');
  assert.equal(page.area.value, 'b');
  page.area.onblur();
  assert.deepEqual(page.texts(), ['b', 'b']);
  page.control.show('b');
  page.sent[1].resolve();
  await settled();
  page.area.onblur();
  assert.equal(page.sent.length, 2);
});

test('what is typed while the text before is on its way stays', () => {
  page.control.show('');
  page.type('a');
  page.area.onchange();
  page.type('ab');
  page.control.show('a');
  assert.equal(page.area.value, 'ab');
  page.area.onblur();
  assert.deepEqual(page.texts(), ['a', 'ab']);
});

test('lines that another client ends in its own way are no change', () => {
  page.control.show('a\r\nb\rc');
  assert.equal(page.area.value, 'a\nb\nc');
  page.area.onblur();
  assert.deepEqual(page.sent, []);
});

test('it holds as many bytes as the server takes', () => {
  page.type('ééééé');
  assert.equal(page.area.value, 'ééééé');
  page.type('éééééé');
  assert.equal(page.area.value, 'ééééé');
  page.type('123456789é');
  assert.equal(page.area.value, '123456789');
});
