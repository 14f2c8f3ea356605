    // The bus: a Wishbone master. What it sets at a falling edge of the clock stands still at the rising one.
    localparam integer ACCESS_CYCLES_MAX = {{ access_cycles_max }};
    reg wb_cyc, wb_stb, wb_we;
    reg [3:0] wb_sel;
    integer wb_ends;
    reg [10:0] wb_adr;
    reg [31:0] wb_dat_to_card;
    wire [31:0] wb_dat_from_card;
    wire wb_ack, wb_err;

    task host_idle;
        begin
            wb_cyc = 1'b0;
            wb_stb = 1'b0;
            wb_sel = 4'b1111;
            wb_we = 1'b0;
            wb_adr = 11'd0;
            wb_dat_to_card = 32'd0;
        end
    endtask

    task transfer(input write, input [31:0] address, input [31:0] value);
        integer k;
        begin
            @(negedge clk);
            wb_cyc = 1'b1;
            wb_stb = 1'b1;
            wb_we = write;
            wb_adr = address[10:0];
            wb_dat_to_card = value;
            for (k = 0; k < ACCESS_CYCLES_MAX && !wb_ack && !wb_err; k = k + 1)
                @(negedge clk);
            check("wb_ack_o", {47'd0, wb_ack}, 48'd1);
            check("wb_err_o", {47'd0, wb_err}, 48'd0);
            answer = wb_dat_from_card;
            @(negedge clk);
            host_idle;
        end
    endtask

    always @(posedge clk)
        if (wb_ack || wb_err)
            wb_ends = wb_ends + 1;

    task strobe_for(input write, input [31:0] value, input integer cycles);
        begin
            @(negedge clk);
            wb_cyc = 1'b1;
            wb_stb = 1'b1;
            wb_we = write;
            wb_adr = CARD_CONFIG_HOLD[10:0];
            wb_dat_to_card = value;
            repeat (cycles)
                @(negedge clk);
        end
    endtask

    // Cycles without strobe, transfers that are left, transfers without a pause, parts of words; at the word that is free for the host.
    task bus_limits;
        integer k;
        begin
            transfer(1'b1, CARD_CONFIG_HOLD, 32'hA1B2C300);
            wb_ends = 0;
            // A cycle without strobe asks for nothing.
            @(negedge clk);
            wb_cyc = 1'b1;
            wb_we = 1'b1;
            wb_adr = CARD_CONFIG_HOLD[10:0];
            wb_dat_to_card = 32'hFFFFFF00;
            repeat (ACCESS_CYCLES_MAX)
                @(negedge clk);
            host_idle;
            // A strobe without cycle is another slave's.
            wb_stb = 1'b1;
            wb_we = 1'b1;
            wb_adr = CARD_CONFIG_HOLD[10:0];
            wb_dat_to_card = 32'hFFFFFF00;
            repeat (ACCESS_CYCLES_MAX)
                @(negedge clk);
            host_idle;
            // Left after one cycle: nothing is written.
            strobe_for(1'b1, 32'hFFFFFF00, 1);
            host_idle;
            repeat (ACCESS_CYCLES_MAX)
                @(negedge clk);
            // Left in the middle of a read: no answer, and the next transfer has its own.
            strobe_for(1'b0, 32'd0, 5);
            host_idle;
            @(negedge clk);
            check("answers without a transfer", wb_ends, 0);
            transfer(1'b0, CARD_ID, 32'd0);
            words_in[0] = answer;
            transfer(1'b0, CARD_ID, 32'd0);
            check("word after a transfer that was left", words_in[0], answer);
            transfer(1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word after transfers that were left", answer, 32'hA1B2C300);
            check("answers to three transfers", wb_ends, 3);
            // Without a pause: the strobe stays.
            wb_ends = 0;
            strobe_for(1'b1, 32'h4D5E6F00, 1);
            for (k = 0; k < 2 * ACCESS_CYCLES_MAX && wb_ends < 2; k = k + 1) begin
                @(negedge clk);
                if (wb_ends == 1) begin
                    wb_we = 1'b0;
                    answer = wb_dat_from_card;
                end
            end
            host_idle;
            check("answers without a pause", wb_ends, 2);
            transfer(1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word written without a pause", answer, 32'h4D5E6F00);
            // A part of a word is refused.
            wb_sel = 4'b1101;
            strobe_for(1'b1, 32'hFFFFFF00, 1);
            for (k = 0; k < ACCESS_CYCLES_MAX && !wb_ack && !wb_err; k = k + 1)
                @(negedge clk);
            check("wb_err_o for a part of a word", {46'd0, wb_ack, wb_err}, 48'd1);
            @(negedge clk);
            host_idle;
            transfer(1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word after a part of it", answer, 32'h4D5E6F00);
            transfer(1'b1, CARD_CONFIG_HOLD, 32'd0);
        end
    endtask
