import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { Colleague } from './colleague.js';
import { Firefox, firefoxIsMissing } from './firefox.js';
import { Server } from './program.js';

const SIZE = { width: 1180, height: 820, pixelRatio: 1 };
const view = "document.querySelector('#view')";

describe('Firefox', { skip: firefoxIsMissing }, () => {
  let server;
  let firefox;
  let colleague; // tells what the server knows

  before(async () => {
    server = await Server.start();
    firefox = await Firefox.launch();
    await firefox.open(server.address, SIZE);
    await firefox.until(`${view}.dataset.level === 'still'`);
    colleague = await Colleague.join(server.address);
  });

  after(async () => {
    await colleague?.leave();
    await firefox?.close();
    await server?.stop();
  });

  test('shows the picture, of its own size', async () => {
    await firefox.until(`${view}.dataset.level === 'still' && ${view}.clientWidth === ${SIZE.width} && ${view}.width === ${SIZE.width}`);
    assert.equal(await firefox.evaluate(`${view}.height`), SIZE.height);
    const colours = await firefox.evaluate(`(() => {
      const { data } = ${view}.getContext('2d').getImageData(0, 0, ${SIZE.width}, ${SIZE.height});
      return new Set(new Uint32Array(data.buffer)).size;
    })()`);
    assert.ok(colours > 1000, `${colours} colours`);
  });

  for (const pointer of ['mouse', 'touch']) {
    test(`a drag turns the camera: ${pointer}`, async () => {
      const { eye } = colleague.state.camera;
      const revision = await firefox.evaluate(`Number(${view}.dataset.revision)`);
      await firefox.point([[500, 400], [540, 405], [600, 410]], pointer);
      await firefox.until(`${view}.dataset.level === 'still' && Number(${view}.dataset.revision) > ${revision}`);
      await colleague.ask({ type: 'tree', depth: 0 });
      assert.notDeepEqual(colleague.state.camera.eye, eye);
      assert.match(await firefox.evaluate("document.querySelector('#presence').textContent"), /^Connected · You are in control/);
    });
  }

  test('the menu opens, the settings from it, and a switch in them switches', async () => {
    const revision = await firefox.evaluate(`Number(${view}.dataset.revision)`);
    await firefox.press('#menu-button');
    await firefox.until("document.querySelector('#menu').classList.contains('open') && getComputedStyle(document.querySelector('#menu')).transform === 'none'");
    await firefox.press('#menu > button');
    await firefox.until("document.querySelector('dialog')?.open");
    await firefox.press('[data-section="renderer"] [role="switch"]');
    await firefox.until("document.querySelector('[data-section=\"renderer\"] [role=\"switch\"]').checked");
    await firefox.until(`Number(${view}.dataset.revision) > ${revision}`);
    await colleague.ask({ type: 'tree', depth: 0 });
    assert.equal(colleague.state.renderer.wireframe, true);
  });

  test('it has nothing to complain of', () => {
    assert.deepEqual(firefox.complaints, []);
  });
});
