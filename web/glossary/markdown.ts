const escaped = (text: string) => text.replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/>/g, '&gt;');

/** Bold, code, and links: those to other pages of docs/ lead to nothing the service has, so their words stay. */
const inline = (text: string) =>
  escaped(text)
    .replace(/`([^`]+)`/g, '<code>$1</code>')
    .replace(/\*\*([^*]+)\*\*/g, '<b>$1</b>')
    .replace(/\[([^\]]+)\]\([^)]*\)/g, '$1');

const row = (line: string, cell: string) =>
  `<tr>${line
    .slice(1, -1)
    .split('|')
    .map((text) => `<${cell}>${inline(text.trim())}</${cell}>`)
    .join('')}</tr>`;

/** Returns docs/glossary.md as HTML: headings, paragraphs, tables. */
export function html(markdown: string): string {
  return markdown
    .trim()
    .split(/\n{2,}/)
    .map((block) => {
      const lines = block.split('\n'),
        heading = /^(#+) (.*)$/.exec(block);
      if (heading?.[1] && heading[2]) return `<h${heading[1].length}>${inline(heading[2])}</h${heading[1].length}>`;
      if (!block.startsWith('|')) return `<p>${inline(lines.join(' '))}</p>`;
      const [head = '', , ...body] = lines;
      return `<table><thead>${row(head, 'th')}</thead><tbody>${body.map((line) => row(line, 'td')).join('')}</tbody></table>`;
    })
    .join('\n');
}
