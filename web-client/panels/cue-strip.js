import { cueAfter, cueNames } from '../base/cues.js';
import { button, element } from '../base/element.js';
import { say } from '../base/texts.js';
import { rows } from './controls.js';
import { stateOf } from './section.js';

/**
 * @import { Store } from '../base/store.js'
 * @import { Commands } from '../connection/commands.js'
 * @import { CuePictures } from './cue-pictures.js'
 */

/**
 * What a presenter has before them: the words for the shown cue, the picture of the next one, and all of them in a row.
 *
 * @param {{store: Store, commands: Commands, pictures: CuePictures, step: (by: 1|-1) => void}} page
 */
export function cueStrip({ store, commands, pictures, step }) {
  const state = () => stateOf(store);
  const picture = () => element('img', { alt: '', draggable: false });
  const words = element('p', { className: 'words', tabIndex: 0 });
  const nextPicture = picture();
  const nextName = element('span');
  const next = button('', () => step(1));
  next.replaceChildren(nextPicture, nextName);
  const card = element('div', { className: 'speaker' }, words, next);
  const list = rows(say('cues.title'), say('cues.none'), (name) => {
    const image = picture();
    const chip = button('', () => commands.cue({ name }));
    chip.replaceChildren(image, element('span', {}, name));
    return {
      children: [chip],
      show({ isShown }) {
        pictures.show(image, name);
        if (isShown && chip.ariaPressed !== 'true') chip.scrollIntoView({ inline: 'center', block: 'nearest' });
        chip.ariaPressed = String(isShown);
      },
    };
  });
  const before = button(say('cues.previous'), () => step(-1), { icon: 'open', only: true });
  before.classList.add('before');
  const after = button(say('cues.next'), () => step(1), { icon: 'open', only: true });
  return {
    content: [element('div', { className: 'presenter' },
      card, element('div', { className: 'cues' }, before, list.element, after))],
    show() {
      const { cues, cue } = state();
      const shown = cue?.name ?? '';
      const following = cueAfter(state(), 1);
      words.textContent = cues[shown]?.text ?? '';
      words.hidden = words.textContent === '';
      next.hidden = following === undefined;
      card.hidden = words.hidden && next.hidden;
      if (following !== undefined) {
        nextName.textContent = say('cues.nextIs', { name: following });
        pictures.show(nextPicture, following);
      }
      before.hidden = after.hidden = Object.keys(cues).length < 2;
      list.show(cueNames(cues).map((name) => [name, { isShown: name === shown }]));
    },
  };
}
