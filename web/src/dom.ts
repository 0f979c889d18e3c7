export const byId = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

/** A colour of the style sheet, as it is now (light or dark). */
export function colour(name: string): string {
  const key = `${name} ${document.documentElement.dataset['theme']}`;
  const found = colours.get(key) ?? getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  colours.set(key, found); // because a chart needs hundreds, and each lookup computes styles
  return found;
}
const colours = new Map<string, string>();

/** Partners keep their colour in every view. */
export const partnerColour = (index: number) => colour(`partner-${index % 6}`);

export function save(name: string, data: Blob): void {
  const address = URL.createObjectURL(data);
  Object.assign(document.createElement('a'), {href: address, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}
