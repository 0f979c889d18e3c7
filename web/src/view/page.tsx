import {createContext} from 'preact';
import {useContext} from 'preact/hooks';
import type {Console} from '../console';

/** The page that a view is of. */
export const Page = createContext<Console | null>(null);
export const useConsole = () => useContext(Page) as Console;
