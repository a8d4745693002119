import assert from 'node:assert/strict';
import { test } from 'node:test';
import { furtherWatchers, personRows, qrPicture } from '../../../web-client/panels/dialogs/people.js';
import { watchingWords } from '../../../web-client/panels/watching.js';

const clients = {
  c1: { name: 'Windows', role: 'control' }, c2: { name: 'iPad', role: 'control' }, c3: { role: 'control' },
  h1: { name: 'Wall', role: 'host' }, v1: { name: 'Android', role: 'view' },
};
const held = (more = {}) => ({ holder: 'c2', name: 'iPad', kept: true, absent: false, asking: [], ...more });
const lines = (rows) => rows.map(([client, { name, words }]) => [client, name, ...words]);
const offered = (rows) => rows.map(([, { actions }]) => actions.map(({ message }) => Object.values(message).join(' ')).join());

test('who is in control comes first, then who may be, walls, and who only watches', () => {
  assert.deepEqual(lines(personRows({ clients, control: held() }, 'c1')), [
    ['c2', 'iPad', 'in control'], ['c3', 'Client c3'], ['c1', 'Windows', 'you'], ['h1', 'Wall', 'wall'],
    ['v1', 'Android', 'only watches'],
  ]);
});

test('a wall that is behind says so', () => {
  const rows = personRows({ clients, control: held() }, 'c1', '12° behind');
  assert.deepEqual(lines(rows)[3], ['h1', 'Wall', 'wall', '12° behind']);
});

test('the holder hands over to others who may be in control, and declines who asks', () => {
  const rows = personRows({ clients, control: held({ asking: [{ client: 'c1', name: 'Windows' }] }) }, 'c2');
  assert.deepEqual(offered(rows), ['', 'give c3', 'give c1,decline c1', '', '']);
  assert.deepEqual(lines(rows)[2], ['c1', 'Windows', 'asks for control']);
  assert.deepEqual(lines(rows)[0], ['c2', 'iPad', 'you', 'in control']);
});

test('others ask the holder, and take that back', () => {
  assert.deepEqual(offered(personRows({ clients, control: held() }, 'c1')), ['ask', '', '', '', '']);
  const asking = [{ client: 'c1', name: 'Windows' }];
  assert.deepEqual(offered(personRows({ clients, control: held({ asking }) }, 'c1')), ['cancel', '', '', '', '']);
});

test('a holder who has lost the connection is there, and can be asked', () => {
  const { c2, ...others } = clients;
  assert.equal(c2.name, 'iPad');
  const rows = personRows({ clients: others, control: held({ absent: true }) }, 'c1');
  assert.deepEqual(lines(rows)[0], ['c2', 'iPad', 'in control', 'has lost the connection']);
  assert.deepEqual(offered(rows)[0], 'ask');
});

test('nobody in control: nobody can be asked', () => {
  const rows = personRows({ clients, control: { kept: false, absent: false, asking: [] } }, 'v1');
  assert.deepEqual(offered(rows), ['', '', '', '', '']);
});

test('watchers whom the state does not name are counted', () => {
  assert.equal(furtherWatchers(clients, { watchers: 7 }), 6);
  assert.equal(furtherWatchers(clients, { watchers: 1 }), 0);
  assert.equal(furtherWatchers(clients, null), 0);
});

test('a QR code is drawn row by row, with light around it', () => {
  assert.match(qrPicture(['110', '001', '000']), /viewBox="-4 -4 11 11".*d="M0 0h2v1h-2zM2 1h1v1h-1z"/);
});

test('who only watches is told so, and who presents', () => {
  assert.equal(watchingWords(held()), 'You are only watching; iPad presents.');
  assert.equal(watchingWords({ kept: false, absent: false, asking: [] }), 'You are only watching; nobody presents now.');
});
