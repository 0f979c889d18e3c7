import {useMemo, useState} from 'preact/hooks';
import {summarise} from '../frame/warnings';
import {chinese, t} from '../language';
import type {Warning} from '../service';
import {choice, plain, saidOf, sentence} from '../words';
import {Original} from './field';
import {useConsole} from './page';

const most = 200; // warnings that are listed at a time; a kind can be chosen

/** The name of a warning and its case; in Chinese the meaning of its code. */
function caseOf(code: Warning['code'], detail: string): string {
  const name = sentence(choice(code));
  const said = saidOf('warnings', code);
  if (said) return `${name}：${said[0]}`;
  return `${name}${detail ? `: ${plain(detail).replace(/\.$/, '')}` : ''}. `;
}

/** A frame's warnings: the kinds and their counts, then those of each member, with what fixes them. */
export function FrameWarnings({warnings}: {warnings: Warning[]}) {
  const console = useConsole();
  const {body, form} = console;
  const [kind, show] = useState('');
  const {counts, groups} = useMemo(() => summarise(warnings, body), [warnings]);
  const shown = groups
    .map((group) => ({...group, reported: group.reported.filter(({warning}) => !kind || warning.code === kind)}))
    .filter(({reported}) => reported.length > 0);
  const choose = (member: number) => {
    form.selection.choose(member);
    document.getElementById('solid')?.scrollIntoView({block: 'nearest'});
  };
  let left = most;
  const total = shown.reduce((sum, {reported}) => sum + reported.length, 0);
  return (
    <div class="by-member">
      <p class="kinds" role="group" aria-label={t('Kinds of warnings')}>
        {counts.map(([code, count]) => (
          <button type="button" key={code} aria-pressed={kind === code} onClick={() => show(kind === code ? '' : code)}>
            {sentence(choice(code))} {count}
          </button>
        ))}
      </p>
      <ul>
        {shown.map(({member, name, reported}) => {
          const part = reported.slice(0, Math.max(0, left));
          left -= part.length;
          if (!part.length) return null;
          return (
            <li key={member ?? -1} class="cut">
              {member !== undefined && (
                <>
                  <b>{name}</b>{' '}
                  <button type="button" aria-label={t('Show {name}', {name})} onClick={() => choose(member)}>
                    {t('Show')}
                  </button>
                </>
              )}
              <ul>
                {part.map(({warning: {code, detail, action}, fixes}, i) => (
                  <li key={i}>
                    {caseOf(code, detail)}
                    {fixes.length === 0 ? (saidOf('warnings', code)?.[1] ?? (action && plain(action))) : null}
                    {fixes.map((each) => (
                      <button type="button" key={each.name} class="fix" onClick={() => form.change(each.apply)}>
                        {each.name}
                      </button>
                    ))}
                    {chinese() && <Original text={detail ? plain(detail) : ''} />}
                  </li>
                ))}
              </ul>
            </li>
          );
        })}
      </ul>
      {total > most && <p class="soft">{t('Choose a kind to see the others.')}</p>}
    </div>
  );
}
