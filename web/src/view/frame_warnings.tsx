import {useMemo, useState} from 'preact/hooks';
import {summarise} from '../frame/warnings';
import type {Warning} from '../service';
import {choice, plain, sentence} from '../words';
import {useConsole} from './page';

const most = 200; // warnings that are listed at a time; a kind can be chosen

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
      <p class="kinds" role="group" aria-label="Kinds of warnings">
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
                  <button type="button" aria-label={`Show ${name}`} onClick={() => choose(member)}>
                    Show
                  </button>
                </>
              )}
              <ul>
                {part.map(({warning: {code, detail, action}, fixes}, i) => (
                  <li key={i}>
                    {`${sentence(choice(code))}${detail ? `: ${plain(detail).replace(/\.$/, '')}` : ''}. `}
                    {fixes.length === 0 && action ? plain(action) : null}
                    {fixes.map((each) => (
                      <button type="button" key={each.name} class="fix" onClick={() => form.change(each.apply)}>
                        {each.name}
                      </button>
                    ))}
                  </li>
                ))}
              </ul>
            </li>
          );
        })}
      </ul>
      {total > most && <p class="soft">Choose a kind to see the others.</p>}
    </div>
  );
}
