import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { Colleague } from './colleague.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, launchBrowser } from './tablet.js';

const PAGE = new URL('../../../web-client/', import.meta.url);
const TABLET = { width: 1180, height: 820, pixelRatio: 1 };
const BLOCK = 20; // pixels; both sides of the view are multiples of it
const CHANGED = 10; // of 255, in the colour of a block; what finer edges do to it is less

describe('the parts of a car on a tablet', { skip: browserIsMissing }, () => {
  let server;
  let browser;
  let tablet;
  let other;
  const ids = {};

  before(async () => {
    server = await Server.start();
    browser = await launchBrowser();
    tablet = await Tablet.open(browser, server.address, TABLET);
    await tablet.wire.still();
    other = await Colleague.join(server.address);
    for (const name of ['Bonnet', 'Boot lid', 'Spoiler', 'Roof', 'Doors']) {
      const { nodes } = await other.ask({ type: 'tree', search: name });
      ids[name] = nodes.find((node) => node.name === name).id;
    }
    await tablet.page.tap('#menu-button');
    await tablet.page.tap('[data-section="parts"] > summary');
  });

  after(async () => {
    other?.leave();
    await browser?.close();
    await server?.stop();
  });

  const named = (name) => tablet.page.getByRole('button', { name, exact: true });
  const isPressed = async (name) => await named(name).getAttribute('aria-pressed') === 'true';
  const unfold = (name) => named(`What ${name} is made of`);
  const asInFile = () => named('As in the file');
  const nodes = () => tablet.wire.state.nodes;

  /** What the canvas shows, in RGBA of blocks. */
  const glance = () => tablet.page.evaluate((block) => {
    const [width, height] = [innerWidth / block, innerHeight / block];
    const small = new OffscreenCanvas(width, height).getContext('2d');
    small.imageSmoothingQuality = 'high';
    small.drawImage(document.querySelector('#view'), 0, 0, width, height);
    return [...small.getImageData(0, 0, width, height).data];
  }, BLOCK);

  const changed = (a, b) => a.filter((value, i) => Math.abs(value - b[i]) > CHANGED).length;

  /** Does something with the hand; the page then shows the state that is waited for, in another picture. */
  async function sees(doing, what, isSo) {
    const { wire } = tablet;
    await tablet.shows((await wire.still()).frame);
    const past = await glance();
    const mark = wire.sent.length;
    await doing();
    await wire.until(what, isSo);
    const last = await wire.until('what was sent', () => wire.sent.slice(mark).findLast(({ type }) => /patch|fit|swing/.test(type)));
    await tablet.shows((await wire.still(last.id)).frame);
    const present = await glance();
    assert.ok(changed(past, present) > 0, `the picture does not show that ${what}`);
    return { past, present, sent: wire.sent.slice(mark) };
  }

  test('its tree begins with what it is made of, and unfolds', async () => {
    const names = tablet.page.getByRole('list', { name: 'All parts' }).locator('> li > .row > [aria-pressed]');
    await names.first().waitFor();
    assert.deepEqual(await names.allTextContents(), ['Body', 'Interior', 'Wheels', 'Drive train', 'Chassis', 'Presentation']);
    assert.equal(await named('Bonnet').count(), 0);
    await unfold('Body').tap();
    await named('Bonnet').waitFor();
    const doors = tablet.page.getByRole('list', { name: 'What Doors is made of' }).locator('> li');
    await unfold('Doors').tap();
    await doors.first().waitFor();
    assert.equal(await doors.count(), 4);
    assert.equal(await unfold('Doors').getAttribute('aria-expanded'), 'true');
    await unfold('Doors').tap();
    assert.equal(await doors.count(), 0);
    assert.equal(await unfold('Doors').getAttribute('aria-expanded'), 'false');
  });

  test('a part is selected, and let go again', async () => {
    const selection = () => tablet.wire.state.selection;
    await sees(() => named('Bonnet').tap(), 'the bonnet is selected', () => selection().node === ids.Bonnet);
    assert.equal(await isPressed('Bonnet'), true);
    await tablet.screenshot('parts-selected');
    await sees(() => named('Bonnet').tap(), 'nothing is selected', () => selection().node === undefined);
    assert.equal(await isPressed('Bonnet'), false);
  });

  test('a part is hidden, and shown again', async () => {
    const hiding = await sees(() => named('Hide Bonnet').tap(), 'the bonnet is hidden', () => nodes()[ids.Bonnet]?.active === false);
    assert.equal(await tablet.page.locator('.off').count(), 1);
    const showing = await sees(() => named('Show Bonnet').tap(), 'it is shown', () => !nodes()[ids.Bonnet]);
    assert.equal(changed(hiding.past, showing.present), 0);
    assert.equal(await tablet.page.locator('.off').count(), 0);
  });

  test('what somebody else hides is grey, with all that is in it, and comes back as in the file', async () => {
    assert.equal(await asInFile().isDisabled(), true);
    const color = () => named('Spoiler').evaluate((button) => getComputedStyle(button).color);
    await other.patch({ nodes: { [ids['Boot lid']]: { active: false } } });
    await tablet.page.locator('.off').waitFor();
    // Only now is it asked for: the answer tells what is the case, and not what is in the file.
    await unfold('Body').tap();
    await unfold('Body').tap();
    await unfold('Boot lid').tap();
    await named('Spoiler').waitFor();
    const grey = await color();
    const { sent } = await sees(() => asInFile().tap(), 'nothing is changed', () => Object.keys(nodes()).length === 0);
    assert.deepEqual(sent.findLast(({ type }) => type === 'patch').patch, { nodes: null });
    await tablet.page.locator('.off').waitFor({ state: 'detached' });
    await named('Hide Boot lid').waitFor();
    assert.notEqual(await color(), grey);
    assert.equal(await asInFile().isDisabled(), true);
  });

  test('a part is found by its name, and the view fits it', async () => {
    const field = tablet.page.getByRole('searchbox', { name: 'Search' });
    const found = (count) => tablet.page.getByRole('status').filter({ hasText: `Found: ${count}` }).waitFor();
    await field.fill('SPOIL');
    await found(1);
    assert.equal(await named('Body').count(), 0);
    const { eye } = tablet.wire.state.camera;
    await sees(() => named('Fit the view to Spoiler').tap(), 'the spoiler is near', () => tablet.wire.state.camera.eye[0] !== eye[0]);

    await field.fill('no such thing');
    await found(0);
    await field.press('Escape');
    assert.equal(await field.inputValue(), '');
    await named('Body').waitFor();
    assert.equal(await tablet.page.locator('#menu.open').count(), 1);
    await field.fill('spoil');
    await found(1);
    await named('Clear the search').tap();
    const near = tablet.wire.state.camera.eye[0];
    await sees(() => named('Fit the view to Body').tap(), 'the body is seen again', () => tablet.wire.state.camera.eye[0] !== near);
  });

  test('one choice paints the whole body', async () => {
    const paint = tablet.page.getByRole('group', { name: '18 parts' });
    const [red, silver] = ['Red', 'Silver'].map((name) => paint.getByRole('radio', { name }));
    assert.equal(await red.isChecked(), true);
    assert.equal(await paint.getByRole('radio').count(), 3);
    const { past, sent } = await sees(() => silver.tap(), 'it is silver',
      () => Object.keys(nodes()).length === 18 && Object.values(nodes()).every(({ activeChild }) => activeChild === 1));
    assert.equal(sent.filter(({ type }) => type === 'patch').length, 1);
    assert.equal(await silver.isChecked(), true);
    await tablet.screenshot('parts-silver');
    const { present } = await sees(() => red.tap(), 'it is red', () => Object.keys(nodes()).length === 0);
    assert.equal(await red.isChecked(), true);
    assert.equal(changed(past, present), 0);
  });

  test('a door swings open, and closes', async () => {
    const { nodes: [door] } = await other.ask({ type: 'tree', node: ids.Bonnet, depth: 0 });
    const bonnet = tablet.page.getByRole('switch', { name: 'Bonnet' });
    const matrix = () => nodes()[ids.Bonnet]?.matrix;
    const opening = await sees(() => bonnet.tap(), 'the bonnet is open', () => {
      const m = matrix();
      if (!m) return false;
      // By as much as its hinge says: the trace of a rotation is 1 + 2 cos.
      const trace = [0, 5, 10].reduce((sum, i) => sum + m[i], 0);
      return Math.abs(trace - 1 - 2 * Math.cos((door.hinge.degrees * Math.PI) / 180)) < 1e-9;
    });
    assert.deepEqual(opening.sent.filter(({ type }) => ['patch', 'swing'].includes(type)).map(({ type }) => type), ['swing']);
    assert.equal(await bonnet.isChecked(), true);
    await tablet.screenshot('parts-bonnet');
    const closing = await sees(() => bonnet.tap(), 'it is closed', () => !matrix());
    assert.equal(changed(opening.past, closing.present), 0);
    assert.equal(await bonnet.isChecked(), false);
  });

  test('a list of many goes on when it is asked to, and a choice of many is a list', async () => {
    // What the server sends is bundled; the module alone comes from its source.
    await tablet.page.route('**/source/**', (route) =>
      route.fulfill({ path: fileURLToPath(new URL(new URL(route.request().url()).pathname.replace('/source/', ''), PAGE)) }));
    await tablet.page.evaluate(async () => {
      const { partsSection } = await import('/source/panels/parts-section.js');
      const state = { scene: {}, selection: {}, nodes: {} };
      const page = (ids, next) => ({ nodes: ids.map((id) => ({ id, name: `Nut ${id}`, parent: 0, active: true, children: 0 })), next });
      const choices = ['a', 'b', 'c', 'd', 'e'];
      const tree = async ({ only, after }) => {
        if (only === 'switches') return { nodes: [{ id: 9, name: 'Seat', choices, activeChild: -1 }] };
        if (only) return { nodes: [] };
        return { undefined: page([], 1), 1: page([1, 2, ...Array.from({ length: 60 }, (_, i) => 100 + i)], 2), 2: page([3]) }[after];
      };
      const section = partsSection({ commands: { tree, change() {} }, store: { now: { state } } });
      const details = document.createElement('details');
      details.id = 'many';
      details.open = true;
      details.append(...section.content);
      document.querySelector('#menu').append(details);
      section.show({ state });
    });
    const many = tablet.page.locator('#many');
    await many.getByRole('button', { name: 'More' }).tap();
    await many.getByRole('button', { name: 'Nut 3', exact: true }).waitFor();
    assert.equal(await many.locator('.tree > li').count(), 63);
    assert.equal(await many.getByRole('button', { name: 'More' }).count(), 0);
    const seat = many.getByRole('combobox', { name: 'Seat' });
    assert.deepEqual(await seat.locator('option').allTextContents(), ['a', 'b', 'c', 'd', 'e', 'None']);
    assert.equal(await seat.inputValue(), '-1');
    await many.evaluate((details) => details.remove());
  });

  test('in all this the browser had nothing to complain of', () => {
    assert.deepEqual(tablet.complaints, []);
  });
});
