import {useLayoutEffect, useRef} from 'preact/hooks';
import {fileName} from './downloads';
import {useConsole} from './page';
import {t} from '../language';

/** A job as a file: to keep, and to open again, also by dropping it on the page. */
export function Jobs() {
  const console = useConsole();
  const input = useRef<HTMLInputElement>(null);
  useLayoutEffect(() => {
    const over = (event: DragEvent) => {
      if ([...(event.dataTransfer?.items ?? [])].some(({type}) => type === 'application/json')) event.preventDefault();
    };
    const drop = (event: DragEvent) => {
      const file = event.dataTransfer?.files[0];
      if (!file || !/\.json$/i.test(file.name)) return;
      event.preventDefault();
      void console.openJob(file);
    };
    addEventListener('dragover', over);
    addEventListener('drop', drop);
    return () => {
      removeEventListener('dragover', over);
      removeEventListener('drop', drop);
    };
  }, [console]);
  const chose = ({currentTarget}: {currentTarget: HTMLInputElement}) => {
    const file = currentTarget.files?.[0];
    if (file) void console.openJob(file);
    currentTarget.value = ''; // the same file once more is a change too
  };
  const name = () => fileName(console.example.value ?? console.endpoint.value, console.body, undefined, null);
  return (
    <>
      <button
        id="open-job"
        type="button"
        title={t('A job out of a file: a request as JSON, such as request.json of a packet. It can be dropped here too')}
        onClick={() => input.current?.click()}
      >
        {t('Open job')}
      </button>
      <input ref={input} type="file" id="job-file" accept=".json,application/json" hidden aria-label={t('A job to open')} onChange={chose} />
      <button id="save-job" type="button" title={t('The request of this job as a file')} onClick={() => console.saveJob(name())}>
        {t('Save job')}
      </button>
    </>
  );
}
