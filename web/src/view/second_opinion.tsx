import type {Certificate} from '../../../clients/check/src/index';
import {later, t} from '../language';
import {beside, sentence, spelled} from '../words';
import {useConsole} from './page';
import {Sheet} from './tables';

/** In as many digits as tell a residual from its bound. */
const figure = (value: number, unit: string) => beside(Number.isInteger(value) ? String(value) : value.toPrecision(2), spelled(unit));

const note = later('Recomputed in this browser by another program, from the answer as the service sent it.');

function Certified({certificate: {checks, notChecked, passed}}: {certificate: Certificate}) {
  const failed = checks.filter((check) => !check.passed).length;
  return (
    <>
      <p data-passed={passed}>
        <b>
          {passed
            ? t('All {all} independent checks hold.', {all: checks.length})
            : t('{failed} of {all} independent checks fail.', {failed, all: checks.length})}
        </b>
      </p>
      <Sheet title={t('Independent checks')} head={[t('Check'), '', t('Found'), t('At most'), t('Places'), '']} note={t(note)} whole>
        {checks.map(({name, value, limit, unit, places, passed: held, where}) => (
          <tr key={name} class={held ? '' : 'failed'}>
            <td lang="en">{sentence(name.replace(/_/g, ' '))}</td>
            <td>{held ? t('ok') : t('FAILED')}</td>
            <td>{figure(value, unit)}</td>
            <td>{figure(limit, unit)}</td>
            <td>{places}</td>
            <td>{where}</td>
          </tr>
        ))}
        {notChecked.map(({pointer, why}) => (
          <tr key={pointer}>
            <td>{pointer}</td>
            <td>{t('not checked')}</td>
            <td colSpan={4}>{why}</td>
          </tr>
        ))}
      </Sheet>
    </>
  );
}

/** The certificate of the shown answer, if one was asked for. */
export function Opinion() {
  const {opinion, reply} = useConsole();
  const shown = opinion.shown.value;
  if (!shown || shown.of !== reply.value) return null;
  const {told} = shown;
  return (
    <section id="opinion" aria-label={t('Independent checks')}>
      <button type="button" class="right" onClick={() => opinion.close()}>
        {t('Close')}
      </button>
      <div role="status">
        {!told ? (
          <p>{t('Checking …')}</p>
        ) : 'failure' in told ? (
          <p>{t('The independent checker failed: {why}', {why: told.failure})}</p>
        ) : (
          <Certified certificate={told.certificate} />
        )}
      </div>
    </section>
  );
}
