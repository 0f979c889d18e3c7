// The Chinese texts of the console: a part of its own, which loads when Chinese is wanted.
import words from 'virtual:words-zh';
import type {Words} from '../../glossary/words';
import captions from './captions.json';
import codes from './codes.json';
import contract from './contract.json';
import descriptions from './descriptions.json';
import names from './names.json';
import pictures from './pictures.json';
import reasons from './reasons.json';
import views from './views.json';

/** The meaning of a code, and the action. */
export type Said = [meaning: string, action: string];
export interface Dictionary {
  /** By the English text. */
  texts: Record<string, string>;
  /** By the wire name, as those of docs/glossary.md. */
  words: Words;
  codes: Record<'errors' | 'warnings', Record<string, Said>>;
  /** Of the service's drawings and lists, by the English caption; with places for values. */
  captions: Record<string, string>;
  /** Of the readers of models, by the English reason; with places for values. */
  reasons: Record<string, string>;
}

export const dictionary: Dictionary = {
  texts: {...contract, ...descriptions, ...names, ...pictures, ...views},
  words,
  captions,
  reasons,
  codes: codes as unknown as Dictionary['codes'],
};
