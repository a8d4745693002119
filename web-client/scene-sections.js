import { byName, choice, color, facts, numbers, range, selection, toggle } from './controls.js';
import { say, written } from './texts.js';

const STYLES = [['vrut', 'VRUT'], ['maya', 'Maya'], ['catia', 'CATIA'], ['cinema4d', 'Cinema 4D']];

/** The five sections of the thesis (chapter 6.9), bound to the state. */
export function sceneSections({ change, state }) {
  return [scene(), renderer(change), camera(change), light(change, state), background(change, state)];
}

/** `bound` are pairs of a control and what it shows, an array, by the state and all else that the page knows. */
function section(name, title, ...bound) {
  return {
    name,
    title,
    content: bound.map(([control]) => control.element),
    show(now) {
      for (const [control, values] of bound) control.show(...values(now.state, now));
    },
  };
}

const nameWord = () => say('Name', 'Název');
const colorWord = () => say('Color', 'Barva');

function scene() {
  const about = facts({
    name: nameWord(),
    nodes: say('Nodes', 'Uzly'),
    materials: say('Materials', 'Materiály'),
    geometries: say('Geometries', 'Geometrie'),
  });
  return section('scene', say('Scene', 'Scéna'), [about, (state) => [state.scene]]);
}

function renderer(change) {
  const set = (member) => (value) => change({ renderer: { [member]: value } });
  const get = (member) => (state) => [state.renderer[member]];
  const modes = [['realistic', say('Realistic', 'Realistické')], ['stylized', say('Stylized', 'Stylizované')]];
  const about = facts({
    solid: say('Opaque', 'Neprůhledné'),
    transparent: say('Transparent', 'Průhledné'),
    reflective: say('Reflective', 'Zrcadlící'),
    time: say('Time to draw (mean of 100)', 'Doba vykreslení (průměr 100)'),
  });
  return section('renderer', say('Renderer', 'Vykreslení'),
    [choice(say('Drawing', 'Zobrazení'), modes, set('mode')), get('mode')],
    [toggle(say('Wireframe', 'Drátový model'), set('wireframe')), get('wireframe')],
    [toggle(say('Show selection', 'Zvýraznit výběr'), set('showSelection')), get('showSelection')],
    [about, (state, { stats }) => {
      const mean = stats?.renderer?.meanRenderMs;
      return [{ ...state.renderer, time: mean && `${written(mean, 1)} ms` }];
    }]);
}

function camera(change) {
  const set = (member) => (value) => change({ navigation: { [member]: value } });
  const get = (member) => (state) => [state.navigation[member]];
  const about = facts({
    name: nameWord(),
    id: 'Id',
    near: say('Near', 'Blízká rovina'),
    far: say('Far', 'Vzdálená rovina'),
    plane: say('Plane size', 'Rozměr roviny'),
  });
  const degrees = { min: 1, max: 170, say: (value) => `${written(value, 1)}°` };
  const fov = range(say('Field of view', 'Zorný úhel'), degrees, (value) => change({ camera: { fov: value } }));
  const factor = { min: 0.01, max: 100, logarithmic: true, step: 0.05, say: (value) => `${written(value, 2)} ×` };
  const speed = (label, member) => [range(label, factor, set(member)), get(member)];
  return section('camera', say('Camera', 'Kamera'),
    [about, ({ camera: now }, { header }) =>
      [{ name: say('Free', 'Volná'), ...now, id: now.node?.toString(), plane: planeSize(now, header?.view) }]],
    [fov, (state) => [state.camera.fov]],
    speed(say('Turn speed', 'Rychlost otáčení'), 'rotateSpeed'),
    speed(say('Move speed', 'Rychlost posunu'), 'panSpeed'),
    speed(say('Zoom speed', 'Rychlost přiblížení'), 'zoomSpeed'),
    [toggle(say('Keep upright', 'Držet svisle'), set('keepUpright')), get('keepUpright')],
    [selection(say('Mouse style', 'Ovládání myší'), set('style')), (state) => [state.navigation.style, STYLES]]);
}

/** Of the near plane, in the scene's unit. */
function planeSize({ fov, near }, view) {
  if (!view) return undefined;
  const height = 2 * near * Math.tan((fov * Math.PI) / 360);
  return `${written((height * view.width) / view.height, 3)} × ${written(height, 3)}`;
}

function light(change, present) {
  const types = {
    headlight: say('Headlight', 'Čelní světlo'),
    point: say('Point', 'Bodové'),
    spot: say('Spot', 'Reflektor'),
    directional: say('Directional', 'Směrové'),
  };
  const set = (member) => (value) => change({ lights: { items: { [present().lights.active]: { [member]: value } } } });
  const get = (member) => ({ lights }) => [lights.items[lights.active][member]];
  const parts = [say('Constant', 'Konstantní'), say('Linear', 'Lineární'), say('Quadratic', 'Kvadratický')];
  return section('light', say('Light', 'Světlo'),
    [selection(say('Active light', 'Aktivní světlo'), (active) => change({ lights: { active } })),
      ({ lights: { active, items: { headlight, ...others } } }) =>
        [active, [['headlight', types.headlight], ...options(others)]]],
    [facts({ name: nameWord(), id: 'Id', type: say('Type', 'Typ') }), ({ lights: { active, items } }) => {
      const { name, type } = items[active];
      const named = active === 'headlight' ? { name: types.headlight } : { name, id: active };
      return [{ ...named, type: types[type] }];
    }],
    [color(colorWord(), set('color')), get('color')],
    [numbers(say('Attenuation', 'Útlum'), parts, set('attenuation')), get('attenuation')]);
}

function background(change, present) {
  const plain = say('Plain color', 'Jednobarevné');
  const setColor = (value) => {
    const { active } = present().backgrounds;
    return change({ backgrounds: active === 'color' ? { color: value } : { items: { [active]: { color: value } } } });
  };
  return section('background', say('Background', 'Pozadí'),
    [selection(say('Active background', 'Aktivní pozadí'), (active) => change({ backgrounds: { active } })),
      ({ backgrounds: { active, items } }) => [active, [['color', plain], ...options(items)]]],
    [facts({ name: nameWord(), id: 'Id', texture: say('Texture', 'Textura') }), ({ backgrounds: { active, items } }) =>
      [active === 'color' ? { name: plain } : { ...items[active], id: active }]],
    [color(colorWord(), setColor), ({ backgrounds: all }) => [(all.items[all.active] ?? all).color]]);
}

function options(items) {
  return Object.entries(items).map(([key, { name }]) => [key, name]).sort(([, a], [, b]) => byName(a, b));
}
