{% if part == "signals" %}
    -- The bus: a Wishbone master. It changes its signals at falling edges of the clock.
    signal wb_cyc, wb_stb, wb_we : std_logic := '0';
    signal wb_adr : std_logic_vector(10 downto 0) := (others => '0');
    signal wb_sel : std_logic_vector(3 downto 0) := "1111";
    signal wb_dat_to_card, wb_dat_from_card : word_t := (others => '0');
    signal wb_ack, wb_err : std_logic;
{% elif part == "procedures" %}
        -- A word; the card refuses to write a part of one.
        procedure transfer (write : boolean; address : natural; value : word_t; bytes : std_logic_vector(3 downto 0) := "1111") is
        begin
            wait until falling_edge(clk);
            wb_cyc <= '1';
            wb_stb <= '1';
            wb_we <= bit_of(write);
            wb_adr <= bits_of(address, 11);
            wb_sel <= bytes;
            wb_dat_to_card <= value;
            for n in 1 to ACCESS_CYCLES_MAX loop
                wait until rising_edge(clk);
                exit when wb_ack = '1' or wb_err = '1';
            end loop;
            check("wb_ack_o", wb_ack, bit_of(not write or bytes = "1111"));
            check("wb_err_o", wb_err, bit_of(write and bytes /= "1111"));
            answer := wb_dat_from_card;
            wait until falling_edge(clk);
            wb_cyc <= '0';
            wb_stb <= '0';
        end procedure;
{% elif part == "steps" %}
        tell("bus: writes of a part of a word");
        for byte in 0 to 3 loop
            transfer(true, CARD_CONFIG_TRIGGER_SOURCES, x"FFFFFFFF", bits_of(2 ** byte, 4));
        end loop;
        read_words(CARD_CONFIG_TRIGGER_SOURCES, 1);
        check("trigger_sources after writes that were refused", words(0), placed(1, TRIGGER_SOURCES_PIN_F));

{% endif %}
