import { cueAfter, cueNames } from '../base/cues.js';
import { button, element } from '../base/element.js';
import { onChange } from '../base/store.js';
import { say } from '../base/texts.js';
import { rows } from './controls.js';
import { stateOf } from './section.js';

/**
 * @import { Now, Store } from '../base/store.js'
 * @import { Pictures } from './pictures.js'
 * @import { Presentation } from './presentation.js'
 */

/**
 * What a presenter has before them: the words for the shown cue, the picture of the next one, and all of them in a row.
 * While they prepare, a tap chooses what this page alone shows until it is taken.
 *
 * @param {{store: Store, pictures: Pictures, presentation: Presentation}} page
 */
export function cueStrip({ store, pictures, presentation }) {
  const state = () => stateOf(store);
  const picture = () => element('img', { alt: '', draggable: false });
  const words = element('p', { className: 'words', tabIndex: 0 });
  const nextPicture = picture();
  const nextName = element('span');
  let following = /** @type {string|undefined} */ (undefined);
  const next = button('', () => following !== undefined && presentation.choose(following));
  next.replaceChildren(nextPicture, nextName);
  const prepare = button(say('cues.prepare'), () => presentation.turnPreparing(), { icon: 'hidden' });
  const take = button(say('cues.take'), () => presentation.take(), { icon: 'present' });
  const keep = button(say('cues.keep'), () => presentation.keep(), { icon: 'camera' });
  take.classList.add('take');
  const card = element('div', { className: 'speaker' }, words, element('div', { className: 'acts' }, prepare, keep, take), next);
  const list = rows(say('cues.title'), say('cues.none'), (name) => {
    const image = picture();
    const chip = button('', () => presentation.choose(name));
    chip.replaceChildren(image, element('span', {}, name));
    return {
      children: [chip],
      show({ isShown, isPrepared }) {
        pictures.show(image, name);
        if (isShown && chip.ariaPressed !== 'true') chip.scrollIntoView({ inline: 'center', block: 'nearest' });
        chip.ariaPressed = String(isShown);
        chip.ariaCurrent = String(isPrepared);
      },
    };
  });
  const presenter = element('div', { className: 'presenter' }, card);
  const before = button(say('cues.previous'), () => presentation.step(-1), { icon: 'open', only: true });
  before.classList.add('before');
  const after = button(say('cues.next'), () => presentation.step(1), { icon: 'open', only: true });
  presenter.append(element('div', { className: 'cues' }, before, list.element, after));
  return {
    content: [presenter],
    show: onChange(shownOf, () => {
      const { cues, cue } = state();
      const { prepares, preparedCamera } = store.now;
      const shown = cue?.name ?? '';
      following = cueAfter(state(), 1);
      words.textContent = cues[prepares ?? shown]?.text ?? '';
      presenter.classList.toggle('wordless', words.textContent === '');
      next.hidden = prepares !== null || following === undefined;
      card.hidden = Object.keys(cues).length === 0;
      prepare.ariaPressed = String(prepares !== null);
      take.hidden = prepares === null;
      keep.hidden = prepares === null || preparedCamera === undefined;
      if (following !== undefined) {
        nextName.textContent = say('cues.nextIs', { name: following });
        pictures.show(nextPicture, following);
      }
      before.hidden = after.hidden = Object.keys(cues).length < 2;
      list.show(cueNames(cues).map((name) => [name, { isShown: name === shown, isPrepared: name === prepares }]));
    }),
  };
}

/** All that the strip depends on, also for its pictures: of the view only its size. @param {Now} now */
export function shownOf({ state, header, prepares, preparedCamera }) {
  const { cues, cue, renderer, scene } = state ?? {};
  return [
    cues, cue, header?.view.width, header?.view.height, renderer?.mode, renderer?.wireframe, scene?.file, prepares,
    preparedCamera === undefined,
  ];
}
