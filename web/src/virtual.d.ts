declare module 'virtual:words' {
  const words: import('../glossary/words').Words;
  export default words;
}
declare module 'virtual:words-zh' {
  const words: import('../glossary/words').Words;
  export default words;
}
