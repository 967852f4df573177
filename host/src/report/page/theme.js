// Light and dark: as the system has it, until the button changes it.

function themeButton() {
  const system = window.matchMedia('(prefers-color-scheme: dark)');
  const button = element('button', { class: 'theme' });
  let chosen = null;
  const apply = () => {
    const theme = chosen || (system.matches ? 'dark' : 'light');
    document.documentElement.dataset.theme = theme;
    button.textContent = theme === 'dark' ? 'Light' : 'Dark';
  };
  button.addEventListener('click', () => {
    chosen = document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark';
    apply();
  });
  system.addEventListener('change', apply);
  apply();
  return button;
}
