import {useEffect, useState} from 'preact/hooks';
import type {Row} from '../json';
import {type Language, language, t} from '../language';
import {acrossTube, sectionMotion, usualMotion} from '../onward';
import type {Chart, Picture} from '../picture';
import type {Context} from '../pictures/context';
import {machineOf, motionFacts, scheduleCharts, wayOf} from '../pictures/schedule';
import {ask, type Reply} from '../service';
import {Charts} from './plots';
import {Figures, Table} from './tables';
import {choice} from '../words';
import {Verdict} from './verdict';

interface Given {
  cut: Row;
  /** The bevels of a target that is not round. */
  section: number[] | undefined;
  context: Context;
  open(body: Row): void;
  focus(pointer: string): void;
  failed(failure: unknown): void;
}
interface Shown {
  of: string;
  spoken: Language;
  reply: Reply;
  charts: Chart[];
  facts?: Pick<Picture, 'figures' | 'tables'>;
}

async function asked(of: string, context: Context): Promise<Shown> {
  const body = JSON.parse(of) as Row;
  const reply = await ask('pulse-schedules', body);
  const spoken = language.value;
  if (!reply.answer) return {of, spoken, reply, charts: []};
  const way = await wayOf(body, reply.answer, context);
  return {of, spoken, reply, charts: scheduleCharts(reply.answer, machineOf(body['machine'], context), way), facts: motionFacts(reply.answer)};
}

let last: Shown | undefined; // kept for who comes back to it

/** The pulses of a cut on a machine, at a speed: the next job in line, shown without leaving this one. */
export function Motion({cut, section, context, open, focus, failed}: Given) {
  // Without a machine that swings the torch, the service's refusal names the missing axis.
  const motion = section ? (sectionMotion(section, context.machines) ?? {...usualMotion, machine: acrossTube}) : usualMotion;
  const body: Row = {cut, ...motion};
  const key = JSON.stringify(body);
  const [shown, show] = useState(last);
  const [turn, again] = useState(0);
  useEffect(() => {
    if (last?.of === key && last.spoken === language.value && last.reply.answer) return;
    let current = true;
    asked(key, context)
      .then((each) => {
        if (!current) return;
        last = each;
        show(each);
      })
      .catch(failed);
    return () => {
      current = false;
    };
  }, [key, turn, language.value]);
  return (
    <>
      <p class="soft">
        {t('On the {machine} at 600 mm/min.', {machine: choice(motion['machine'])})}{' '}
        <button type="button" id="open-pulses" onClick={() => open(body)}>
          {t('Change machine, speed, lead …')}
        </button>
      </p>
      <div class="motion">
        <Charts class="motion" charts={shown?.charts ?? []} failed={failed} />
        {shown?.facts && (
          <div class="extra">
            <div class="figures">
              <Figures figures={shown.facts.figures} />
            </div>
            <div class="columns">
              {shown.facts.tables?.map((each) => (
                <Table key={each.title} {...each} />
              ))}
            </div>
          </div>
        )}
        {shown?.reply.problem && <Verdict reply={shown.reply} focus={(pointer) => focus(pointer.replace(/^\/cut/, ''))} again={() => again(turn + 1)} />}
      </div>
    </>
  );
}
