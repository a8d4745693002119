import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { Colleague } from './colleague.js';
import { Server } from './program.js';
import { Tablet, browserIsMissing, difference, launchBrowser } from './tablet.js';

const TABLET = { width: 1180, height: 820, pixelRatio: 1 };
const UPRIGHT = { width: 820, height: 1180, pixelRatio: 1 };
const PHONE = { width: 390, height: 844, pixelRatio: 1 };
const IN_MENU = ['parts', 'views', 'cues', 'notes', 'sections', 'measures', 'presentation'];
const SECTIONS = ['scene', 'renderer', 'camera', 'light', 'background'];
const IN_SETTINGS = [...SECTIONS, 'quality', 'recording', 'connection'];
const LEAST_TARGET = 48;
/** Of 255: by less than this a picture differs from itself, refined or compressed anew. */
const VISIBLE = 6;
const BODY = 100; // a node of the car

let browser;

before(async () => {
  if (!browserIsMissing) browser = await launchBrowser();
});

after(() => browser?.close());

for (const [name, size] of Object.entries({ 'a tablet': TABLET, 'an upright tablet': UPRIGHT, 'a phone': PHONE })) {
  describe(`the menu and the settings of ${name}`, { skip: browserIsMissing }, () => {
    const testOnTablet = size === TABLET ? test : () => {};
    let server;
    let tablet;
    let page;
    let colleague;

    before(async () => {
      server = await Server.start();
      tablet = await Tablet.open(browser, server.address, size, { reducedMotion: 'reduce' });
      ({ page } = tablet);
      await tablet.wire.still();
      await tablet.pictures(false);
      colleague = await Colleague.join(server.address);
    });

    after(async () => {
      await colleague?.leave();
      await page?.context().close();
      await server?.stop();
    });

    const opens = () => page.locator('#menu.open').waitFor();
    const closes = () => page.locator('#menu.open').waitFor({ state: 'detached' });
    const focused = () => page.evaluate(() => document.activeElement?.id);
    const section = (key) => page.locator(`[data-section="${key}"]`);
    const within = (key, label) => section(key).getByLabel(new RegExp(`^${label}`));

    /** Does something; waits until the state is as expected, and where it is `seen`, until the picture is another. */
    async function changes(act, expected, { seen = false } = {}) {
      const glance = seen && await tablet.glance();
      await act();
      await tablet.wire.until(`the state after ${act}`, () => expected(tablet.wire.state));
      if (seen) {
        const by = difference(glance, await tablet.glance(tablet.wire.revision));
        assert.ok(by > VISIBLE, `the picture has changed by ${by} after ${act}`);
      }
    }

    const seen = { seen: true };

    test('a button at the top right opens it, by finger and by key', async () => {
      await closes();
      const box = await page.locator('#menu-button').boundingBox();
      assert.ok(box.x + box.width > size.width - 24 && box.y < 24, JSON.stringify(box));
      await page.getByRole('button', { name: 'Menu' }).tap();
      await opens();
      assert.equal(await page.locator('#menu-button').getAttribute('aria-expanded'), 'true');
      await page.getByRole('button', { name: 'Close the menu' }).tap();
      await closes();
      assert.equal(await page.locator('#menu-button').getAttribute('aria-expanded'), 'false');

      await page.locator('#menu-button').focus();
      await page.keyboard.press('Enter');
      await opens();
      await page.keyboard.press('Escape');
      await closes();
      assert.equal(await focused(), 'menu-button');
      assert.deepEqual(tablet.wire.sent.filter(({ type }) => type.startsWith('key')), []);
    });

    test('opened by a finger, it has the focus, until the picture is touched', async () => {
      const holdsFocus = () => page.evaluate(() => document.querySelector('#menu').contains(document.activeElement));
      await page.locator('#menu-button').tap();
      await opens();
      assert.equal(await holdsFocus(), true);
      await page.touchscreen.tap(...(size === PHONE ? [200, 200] : [200, 400]));
      await page.waitForFunction(() => document.activeElement.id === 'view');
      await page.getByRole('button', { name: 'Close the menu' }).tap();
      await closes();
    });

    test('closed, it is out of the way of keys and fingers', async () => {
      await page.locator('#menu-button').focus();
      await page.keyboard.press('Tab');
      assert.equal(await page.evaluate(() => document.querySelector('#menu').contains(document.activeElement)), false);
    });

    async function unfoldsAndFolds(where, expected) {
      const names = await page.locator(`${where} details`).evaluateAll((all) => all.map(({ dataset }) => dataset.section));
      assert.deepEqual(names, expected);
      for (const key of names) {
        const was = await section(key).evaluate(({ open }) => open);
        await section(key).locator('summary').tap();
        await page.locator(`[data-section="${key}"]${was ? ':not([open])' : '[open]'}`).waitFor();
        if (was) await section(key).locator('summary').press('Enter');
        await page.locator(`[data-section="${key}"][open]`).waitFor();
      }
    }

    test('its sections unfold and fold, and those of the settings', async () => {
      await page.locator('#menu-button').tap();
      await unfoldsAndFolds('#menu', IN_MENU);
      await tablet.screenshot(`menu-${size.width}`);
      await page.getByRole('button', { name: 'Settings' }).tap();
      await page.locator('dialog').waitFor();
      await unfoldsAndFolds('dialog', IN_SETTINGS);
      await tablet.screenshot(`settings-${size.width}`);
    });

    testOnTablet('the scene and what draws it are told', async () => {
      const told = (key) => page.locator(`dialog [data-fact="${key}"]`).first().textContent();
      const { scene, renderer } = tablet.wire.state;
      assert.equal(await told('name'), scene.name);
      for (const key of ['nodes', 'materials', 'geometries']) assert.equal(await told(key), String(scene[key]));
      for (const key of ['solid', 'transparent', 'reflective']) assert.equal(await told(key), String(renderer[key]));
      await page.waitForFunction(() => /\u00a0ms$/.test(document.querySelector('[data-fact="time"]').textContent));
    });

    async function assertRoom(where, mostly) {
      const { small, out, targets } = await page.evaluate(([least, selector]) => {
        const panel = document.querySelector(selector);
        const { left, right } = panel.getBoundingClientRect();
        const big = (element) => {
          const { width, height } = element.getBoundingClientRect();
          return width >= least && height >= least;
        };
        const shown = (element) => element.checkVisibility();
        const found = [...panel.querySelectorAll('button, input, select, textarea, summary, a')].filter(shown);
        const name = (element) => `${element.outerHTML.slice(0, 90)} ${JSON.stringify(element.getBoundingClientRect())}`;
        return {
          targets: found.length,
          small: found.filter((element) => !big(element) && !(element.closest('label') && big(element.closest('label')))).map(name),
          out: [...panel.querySelectorAll('*')].filter(shown).filter((element) => {
            const box = element.getBoundingClientRect();
            return box.left < left - 0.5 || box.right > right + 0.5;
          }).map(name).concat(panel.scrollWidth > panel.clientWidth ? [`the panel: ${panel.scrollWidth} > ${panel.clientWidth}`] : []),
        };
      }, [LEAST_TARGET, where]);
      assert.ok(targets > mostly, `${targets} targets`);
      assert.deepEqual(small, []);
      assert.deepEqual(out, []);
    }

    test('nothing in them is too small for a finger, and nothing sticks out', async () => {
      await assertRoom('#menu', 20);
      await assertRoom('dialog', 20);
    });

    testOnTablet('the renderer', async () => {
      const renderer = section('renderer');
      await changes(() => within('renderer', 'Stylized').tap(), (state) => state.renderer.mode === 'stylized', seen);
      await changes(async () => {
        await within('renderer', 'Stylized').focus();
        await page.keyboard.press('ArrowLeft');
      }, (state) => state.renderer.mode === 'realistic', seen);
      await changes(() => renderer.getByText('Wireframe').tap(), (state) => state.renderer.wireframe, seen);
      await changes(() => within('renderer', 'Wireframe').press('Space'), (state) => !state.renderer.wireframe, seen);
      await tablet.glance(await colleague.patch({ selection: { node: BODY } }));
      await changes(() => renderer.getByText('Show selection').tap(), (state) => !state.renderer.showSelection, seen);
    });

    testOnTablet('a control does not jump back before the next display frame tells the news', async () => {
      const seenChecked = await within('renderer', 'Wireframe').evaluate(async (input) => {
        const { requestAnimationFrame: request, cancelAnimationFrame: cancel } = window;
        const waiting = new Map();
        let last = 0;
        const display = () => {
          const now = [...waiting.values()];
          waiting.clear();
          for (const act of now) act(performance.now());
        };
        window.requestAnimationFrame = (act) => {
          last += 1;
          waiting.set(last, act);
          return last;
        };
        window.cancelAnimationFrame = (id) => waiting.delete(id);
        const checked = [];
        const look = () => checked.push(input.checked);
        const socket = window.sockets.at(-1);
        const answered = new Promise((resolve) => {
          const unheard = new Set(['patch', 'ok']);
          socket.addEventListener('message', function listen({ data }) {
            look();
            if (typeof data === 'string') unheard.delete(JSON.parse(data).type);
            if (unheard.size > 0) return;
            socket.removeEventListener('message', listen);
            resolve();
          });
        });
        const tasks = async () => {
          for (let i = 0; i < 20; i += 1) {
            await new Promise((resolve) => setTimeout(resolve));
            look();
          }
        };
        input.click();
        look();
        await tasks();
        display();
        look();
        await answered;
        await tasks();
        display();
        look();
        Object.assign(window, { requestAnimationFrame: request, cancelAnimationFrame: cancel });
        return checked;
      });
      assert.ok(seenChecked.length > 40 && !seenChecked.includes(false), String(seenChecked));
      await tablet.wire.until('wireframe', () => tablet.wire.state.renderer.wireframe);
      await changes(() => within('renderer', 'Wireframe').press('Space'), (state) => !state.renderer.wireframe);
    });

    testOnTablet('the camera', async () => {
      await changes(async () => {
        const slider = within('camera', 'Field of view');
        await slider.scrollIntoViewIfNeeded();
        const { x, y, width, height } = await slider.boundingBox();
        const { fov } = tablet.wire.state.camera;
        const at = x + 14 + ((width - 28) * (fov - 1)) / 169;
        await tablet.stroke([{ from: [at, y + height / 2], to: [at + 0.2 * width, y + height / 2] }]);
      }, (state) => state.camera.fov > 50, seen);
      for (const [label, member] of [['Turn speed', 'rotateSpeed'], ['Move speed', 'panSpeed'], ['Zoom speed', 'zoomSpeed']]) {
        await changes(() => within('camera', label).press('ArrowRight'), (state) => state.navigation[member] > 1);
        const { navigation } = tablet.wire.state;
        await changes(() => within('camera', label).press('Home'), (state) => state.navigation[member] === 0.01);
        assert.ok(navigation[member] < 1.2, `${member} ${navigation[member]}`);
      }
      await changes(() => section('camera').getByText('Keep upright').tap(), (state) => !state.navigation.keepUpright);
      await changes(() => within('camera', 'Mouse style').press('m'), (state) => state.navigation.style === 'maya');
    });

    testOnTablet('the light', async () => {
      await changes(() => within('light', 'Active light').press('K'), (state) => state.lights.items[state.lights.active].name === 'Key', seen);
      const key = () => tablet.wire.state.lights.items[tablet.wire.state.lights.active];
      await changes(() => within('light', 'Color').fill('#ff0000'), () => key().color.join() === '1,0,0,1', seen);
      await changes(async () => {
        const field = within('light', 'Linear');
        await field.tap();
        await field.fill('');
        await page.keyboard.type('12');
        await page.keyboard.press('Enter');
      }, () => key().attenuation.join() === '1,12,0', seen);
      await within('light', 'Linear').fill('-1');
      await page.keyboard.press('Enter');
      await page.waitForFunction(() => document.querySelectorAll('[data-section="light"] .numbers input')[1].value === '12');
      assert.deepEqual(key().attenuation, [1, 12, 0]);
      // The second before the server has said anything to the first.
      await changes(() => section('light').locator('.numbers input').evaluateAll((fields) => {
        for (const [i, value] of [[1, '5'], [2, '3']]) {
          fields[i].value = value;
          fields[i].dispatchEvent(new Event('change'));
        }
      }), () => key().attenuation.join() === '1,5,3');
      // A value that the server rejects is replaced when the field loses the focus.
      const { errors } = tablet.wire;
      const refused = errors.length;
      await within('light', 'Linear').fill('1e31');
      await page.keyboard.press('Enter');
      await tablet.wire.until('a refusal', () => errors.length > refused);
      assert.equal(await within('light', 'Linear').inputValue(), '1e31');
      await within('light', 'Constant').focus();
      await page.waitForFunction(() => document.querySelectorAll('[data-section="light"] .numbers input')[1].value === '5');
    });

    testOnTablet('the background', async () => {
      await changes(() => within('background', 'Active background').press('P'), (state) => state.backgrounds.active === 'color', seen);
      await changes(() => within('background', 'Color').fill('#00ff00'), (state) => state.backgrounds.color.join() === '0,1,0,1', seen);
    });

    testOnTablet('keys typed in it do not steer', () => {
      assert.deepEqual(tablet.wire.sent.filter(({ type }) => type.startsWith('key')), []);
    });

    testOnTablet('it follows what others do', async () => {
      await colleague.patch({
        renderer: { mode: 'stylized', wireframe: true },
        camera: { fov: 33 },
        lights: { active: 'headlight', items: { headlight: { color: [0, 0, 1, 1], attenuation: [1, 2, 3] } } },
        backgrounds: { active: '911' },
        navigation: { zoomSpeed: 10, style: 'catia', keepUpright: true },
      });
      await page.waitForFunction(() => document.querySelector('[data-section="renderer"] [role=switch]').checked);
      assert.equal(await within('renderer', 'Stylized').isChecked(), true);
      assert.equal(await within('camera', 'Field of view').inputValue(), '33');
      assert.equal(await within('camera', 'Zoom speed').getAttribute('aria-valuetext'), '10 ×');
      assert.equal(await within('camera', 'Mouse style').inputValue(), 'catia');
      assert.equal(await within('camera', 'Keep upright').isChecked(), true);
      assert.equal(await within('light', 'Active light').inputValue(), 'headlight');
      assert.equal(await within('light', 'Color').inputValue(), '#0000ff');
      assert.deepEqual(await section('light').locator('.numbers input').evaluateAll((all) => all.map(({ value }) => value)), ['1', '2', '3']);
      assert.equal(await within('background', 'Active background').inputValue(), '911');
    });

    testOnTablet('a change that is refused is explained, and taken back', async () => {
      await colleague.ask({ type: 'control', action: 'take' });
      await tablet.wire.until('the other one to steer', () => tablet.wire.state.control.holder === colleague.id);
      const refused = tablet.wire.errors.length;
      await section('renderer').getByText('Wireframe').tap();
      await tablet.wire.until('a refusal', () => tablet.wire.errors.at(-1)?.code === 'not-in-control');
      await page.locator('#lines').getByText(`Client ${colleague.id} is in control.`).waitFor();
      await page.waitForFunction(() => document.querySelector('[data-section="renderer"] [role=switch]').checked);
      await within('camera', 'Field of view').press('ArrowRight');
      await tablet.wire.until('another refusal', () => tablet.wire.errors.length === refused + 2);
      await page.waitForFunction(() => document.querySelector('[data-section="camera"] [type=range]').value === '33');
      await tablet.screenshot(`menu-${size.width}-refused`);
      await colleague.ask({ type: 'control', action: 'release' });
    });

    testOnTablet('it speaks Czech, and remembers that', async () => {
      const words = () => page.evaluate((keys) => keys.flatMap((key) =>
        [...document.querySelectorAll(`[data-section="${key}"] :is(h2, dt, legend, label > span:not(.value))`)].map(({ textContent }) => textContent)), SECTIONS);
      const english = await words();
      await tablet.closeSettings();
      await page.getByRole('button', { name: 'Čeština' }).tap();
      await page.locator('html[lang="cs"]').waitFor();
      await tablet.settings('scene');
      const czech = await words();
      assert.equal(czech.length, english.length);
      assert.deepEqual([...new Set(czech.filter((word, i) => word === english[i]))], ['Id']);
      await page.waitForFunction(() => document.querySelector('#presence').textContent.startsWith('Připojeno'));
      await tablet.closeSettings();
      await page.keyboard.press('Escape');
      await closes();

      await page.reload();
      await tablet.wire.still();
      await page.locator('html[lang="cs"]').waitFor();
      await page.getByRole('button', { name: 'Nabídka' }).tap();
      await opens();
      await tablet.screenshot(`menu-${size.width}-czech`);
      await tablet.settings('scene');
      assert.deepEqual(await words(), czech);
      await tablet.screenshot(`settings-${size.width}-czech`);
    });

    test('pinches, double taps and drags do not move the page', async () => {
      const facts = section('scene').locator('.facts');
      await facts.scrollIntoViewIfNeeded();
      const { x, y, width, height } = await facts.boundingBox();
      const beside = size === PHONE ? [x + width / 2, 150] : [200, 300];
      for (const [left, top] of [[x + width / 2, y + height / 2], beside]) {
        await tablet.stroke([{ from: [left - 20, top], to: [left - 90, top] }, { from: [left + 20, top], to: [left + 90, top] }]);
        await page.touchscreen.tap(left, top);
        await page.touchscreen.tap(left, top);
        await tablet.stroke([{ from: [left, top], to: [left + 60, top - 90] }]);
        await tablet.stroke([{ from: [left, top], to: [left - 60, top + 90] }]);
      }
      const moved = await page.evaluate(() => [
        visualViewport.scale, visualViewport.offsetTop, visualViewport.pageTop, scrollX, scrollY,
        document.documentElement.scrollTop, document.body.scrollTop, document.querySelector('#stage').scrollTop,
      ]);
      assert.deepEqual(moved, [1, 0, 0, 0, 0, 0, 0, 0]);
    });

    test('in all this the browser had nothing to complain of', () => {
      assert.deepEqual(tablet.complaints, []);
    });
  });
}

test('a Czech browser gets Czech, the errors of the server too', { skip: browserIsMissing }, async () => {
  const server = await Server.start();
  const tablet = await Tablet.open(browser, server.address, PHONE, { locale: 'cs-CZ', reducedMotion: 'reduce' });
  const { page, wire } = tablet;
  const colleague = await Colleague.join(server.address);
  try {
    await wire.still();
    await page.locator('html[lang="cs"]').waitFor();
    await colleague.ask({ type: 'control', action: 'take' });
    await (await tablet.settings('renderer')).getByText('Drátový model').tap();
    await page.locator('#lines').getByText(`Řídí Klient ${colleague.id}.`).waitFor();
    await colleague.ask({ type: 'control', action: 'release' });
    await (await tablet.settings('recording')).getByRole('button', { name: 'Nahrávat' }).tap(); // the server has no folder for that
    await page.locator('#lines').getByText('Tato akce zde není povolena').waitFor();
  } finally {
    await colleague.leave();
    await page.context().close();
    await server.stop();
  }
});
